// SPDX-License-Identifier: Apache-2.0
//
// Localisation of robots that don't know their true poses: errors of calibration, slip, codes on
// the floor that are read or missed, and robots that get lost. Estimates are in core/estimation.
#pragma once

#include "core/state/views/task_view.h"
#include "kiva_plugin_cpp/odometry.h"

namespace kiva {

/// Distance before a code's centre from which it is read, as soon as it is in view [m].
constexpr double kReadBefore = 0.04;

/// Draws the calibration of a new robot's wheels, and sets its estimate to its pose.
void calibrate(RobotView& world, int robot);
/// Sets the estimate of a robot that was placed by hand to its pose.
void relocate(RobotView& world, int robot);
/// Updates the estimate after a step in which the robot did not cruise, by its wheels and by codes
/// that come into view.
void track(TaskView& world, int robot);
/// Reads codes in view. A code is read, or missed, once in passing, and again if the robot `stands`
/// on it.
void readCode(RobotView& world, int robot, bool stands);
/// Draws the slip of the wheels for the next `length` [m].
void drawSlip(RobotView& world, int robot, double length);
/// Returns the robot's odometry: in world, or in its own frame while it is steered.
Odometry odometryOf(const Scene& world, int robot);
/// Stops a robot that has gone too far without a code, and reports it as lost. Returns whether it
/// is lost.
bool checkLost(TaskView& world, int robot);

}  // namespace kiva
