// SPDX-License-Identifier: Apache-2.0
//
// Odometry of steered robots: the way that wheels have counted since the robot was handed over, in
// a frame of its own. It reads no codes, and never jumps.
#pragma once

#include "core/state/views/robot_view.h"
#include "kiva_plugin_cpp/odometry.h"

namespace kiva {

/// Begins the robot's odometry at its pose, without uncertainty.
void beginOdometry(RobotView& world, int robot);
/// Returns the robot's pose in the frame of its odometry.
PlanarPose countedPose(const FleetState& fleet, int robot);
/// Keeps the pose in that frame although the robot was put elsewhere by hand.
void keepOdometry(RobotView& world, int robot, const PlanarPose& counted);
/// Adds the uncertainty of the way since the last call, once that is long enough. That of the
/// wheels' separation is kept apart: it is the same error in every turn, and adds up.
void growUncertainty(RobotView& world, int robot);
/// Adds the uncertainty of the wheels' separation to the robot's odometry, and changes that from
/// world to the frame of its own.
void makeLocal(const Scene& world, int robot, Odometry* odometry);

}  // namespace kiva
