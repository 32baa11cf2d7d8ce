// SPDX-License-Identifier: Apache-2.0
//
// A differential drive on the floor as five degrees of freedom: a planar chassis and two wheels.
#pragma once

#include "core/state/fleet_state.h"

namespace kiva {

/// Changes velocities and wheel speeds of robot `i` by one step's motor torques and floor friction;
/// positions stay. `dt` in [s].
void applyTraction(FleetState& fleet, int i, double gravity, double dt);

/// Moves robot `i` by one step at its velocities (semi-implicit Euler, as Bullet does).
void integrate(Fleet& fleet, int i, double dt);

/// Acceleration [m/s²] along the heading that both motors can give the loaded robot without slip.
double drivingLimit(const Robot& robot, double gravity);

/// Acceleration [rad/s²] with which both motors can turn the loaded robot in place without slip.
double turningLimit(const Robot& robot, double gravity);

/// Exactly at rest: no motion, no motor asked for any.
bool atRest(const FleetState& fleet, int i);

}  // namespace kiva
