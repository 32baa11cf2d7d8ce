// SPDX-License-Identifier: Apache-2.0
//
// Locates robots that are not told their poses: they are calibrated badly, roll, slip, read codes
// on the floor or miss them, and are lost at last. Their estimates are in core/estimation.
#pragma once

#include "core/state/views/motion_view.h"
#include "kiva_plugin_cpp/odometry.h"

namespace kiva {

/// [m] before a code's middle at which its reading is done: as soon as it is in view.
constexpr double kReadBefore = 0.04;

/// Draws the calibration of a new robot's wheels, and tells it its pose.
void calibrate(MotionView& world, int robot);
/// Tells a robot that was placed by hand its pose.
void relocate(MotionView& world, int robot);
/// Updates the estimate after a step in which the robot did not cruise, by its wheels and by codes
/// that come into view.
void track(MotionView& world, int robot);
/// Reads the floor. A code that is in view is read, or missed, once as it is passed; again if
/// the robot `stands` on it.
void readCode(MotionView& world, int robot, bool stands);
/// Draws the slip of its wheels on the next `length` [m].
void drawSlip(MotionView& world, int robot, double length);
/// Returns what the robot's odometry says now.
Odometry odometryOf(const Scene& world, int robot);
/// Stops a robot that has gone too far without a code, and reports it as lost. Returns whether it
/// is.
bool checkLost(MotionView& world, int robot);

}  // namespace kiva
