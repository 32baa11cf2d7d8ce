// SPDX-License-Identifier: Apache-2.0
//
// A differential drive on the floor as five degrees of freedom: a planar chassis and two wheels.
#pragma once

#include "core/motion/wheels/vehicle.h"
#include "core/state/robots/fleet_state.h"

namespace kiva {

/// Changes velocities and wheel speeds of robot `i` by one step of motor torques and floor
/// friction; positions stay. `dt` in [s].
void applyTraction(FleetState& fleet, int i, const Ground& ground, double dt);

/// Moves robot `i` by one step of its velocities (semi-implicit Euler, as Bullet does).
void integrate(Fleet& fleet, int i, double dt);

/// Returns whether a robot is exactly at rest, with no motor commanded to move.
bool atRest(const FleetState& fleet, int i);

}  // namespace kiva
