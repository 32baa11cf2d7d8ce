// SPDX-License-Identifier: Apache-2.0
//
// A robot cruises while it follows the reference of its segment exactly and nothing can come near:
// its motors and the floor have force to spare, so that wheels and chassis do what the profile
// says. Then a step is a few operations on arrays, several robots at a time; the same motion, to
// rounding errors, as traction's equations give.
#pragma once

#include <cmath>

#include "core/state/world_state.h"

namespace kiva {

/// What a unit of a segment's reference moves, and how the reference goes.
struct Motion {
  double x = 0, y = 0, yaw = 0;  ///< Of the chassis in world [m, m, rad].
  double top_speed = 0;          ///< [m/s or rad/s]
  double acceleration = 0;       ///< [m/s² or rad/s²]; 0 = at once.
};

/// Whether an error [m, rad, m/s, rad/s] may be rounding's.
inline bool isExact(double error) { return std::abs(error) < 2e-11; }

/// Lets the robot cruise along its segment from this step on, if it is fit for it and its way is
/// free.
bool tryCruise(WorldState& world, int robot, const Motion& per);

/// Back to the equations, from the next step on.
void stopCruise(Fleet& fleet, int robot);

/// One step of all who cruise. Those whose reference ends, or who may have somebody near, stop.
void cruise(WorldState& world);

}  // namespace kiva
