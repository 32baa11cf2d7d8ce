// SPDX-License-Identifier: Apache-2.0
//
// Cruising: a robot follows the reference of its segment exactly and nothing can come near. Its
// motors and the floor have force to spare, so that wheels and chassis move as the profile. A step
// then is a few operations on arrays, for several robots at a time. The motion is that of
// traction's equations, up to rounding errors.
#pragma once

#include <cmath>

#include "core/state/views/motion_view.h"

namespace kiva {

/// The motion of the chassis in world a unit of reference [m or rad], and the limits of the
/// reference's speed.
struct ReferenceMotion {
  double x = 0, y = 0, yaw = 0;  ///< [m, m, rad] a unit of reference.
  double top_speed = 0;          ///< [m/s or rad/s]
  double acceleration = 0;       ///< [m/s² or rad/s²]; 0 = at once.
};

/// Returns whether an error [m, rad, m/s, rad/s] may be due to rounding: steps that add to
/// coordinates of hundreds of metres leave up to 1e-9 m.
inline bool isExact(double error) { return std::abs(error) < 1e-8; }

/// Starts a cruise along the segment with this step, if the robot can and its way is free. The
/// cruise lasts until something else moves the robot, see moved(). Returns whether it cruises.
bool tryCruise(RobotView& world, Obstacles& obstacles, int robot, const ReferenceMotion& per);

/// Sets the end of the robot's reference, without a dip in its speed.
void setReferenceEnd(RobotView& world, Obstacles& obstacles, int robot, double goal);

/// Advances all cruising robots by one step. A robot stops cruising where its reference ends, or
/// where it may meet others.
void cruise(MotionView& world);

}  // namespace kiva
