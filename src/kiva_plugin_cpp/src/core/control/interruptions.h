// SPDX-License-Identifier: Apache-2.0
//
// Cancels, stops and resumes commands under way.
#pragma once

#include "core/state/views/motion_view.h"

namespace kiva {

/// Ends the robot's command in DONE at the next grid point where it can stop; a lift at its end.
/// Throws Refusal if there is nothing to cancel.
void cancel(TaskView& world, Obstacles& obstacles, int robot);
/// Stops wheels and tower as hard as possible, and holds them until goOn().
void stop(RobotView& world, int robot);
/// Resumes the robot's command from its present pose.
void goOn(RobotView& world, int robot);
/// Plans the present segment again from the robot's pose, after a stop or a change of limits.
void replan(RobotView& world, int robot);

}  // namespace kiva
