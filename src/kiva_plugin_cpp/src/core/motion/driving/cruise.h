// SPDX-License-Identifier: Apache-2.0
//
// A robot cruises while it follows the reference of its segment exactly and nothing can come near:
// its motors and the floor have force to spare, so that wheels and chassis do what the profile
// says. Then a step is a few operations on arrays, several robots at a time; the same motion, to
// rounding errors, as traction's equations give.
#pragma once

#include <cmath>

#include "core/state/views/motion_view.h"

namespace kiva {

/// Where the reference of a segment goes: what a unit of it [m or rad] moves the chassis in world,
/// and how fast it may go.
struct ReferenceMotion {
  double x = 0, y = 0, yaw = 0;  ///< [m, m, rad] a unit.
  double top_speed = 0;          ///< [m/s or rad/s]
  double acceleration = 0;       ///< [m/s² or rad/s²]; 0 = at once.
};

/// Returns whether an error [m, rad, m/s, rad/s] may be rounding's: steps that add to coordinates
/// of hundreds of metres leave up to 1e-9 m.
inline bool isExact(double error) { return std::abs(error) < 1e-8; }

/// Lets the robot cruise along its segment from this step on, if it is fit for it and its way is
/// free. It does until something else moves it, see moved().
bool tryCruise(MotionView& world, int robot, const ReferenceMotion& per);

/// Sets where the robot's reference ends; its speed changes without a dip.
void setGoal(MotionView& world, int robot, double goal);

/// Moves all cruising robots by one step. Those whose reference ends, or that may meet others, stop
/// cruising.
void cruise(MotionView& world);

}  // namespace kiva
