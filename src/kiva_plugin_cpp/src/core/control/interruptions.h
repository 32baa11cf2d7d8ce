// SPDX-License-Identifier: Apache-2.0
//
// Cancels, stops and resumes commands under way.
#pragma once

#include "core/state/views/motion_view.h"

namespace kiva {

/// Ends the robot's command in DONE at the next grid point where it can stop; a lift when it is
/// over. Throws Refusal if there is nothing to cancel.
void cancel(MotionView& world, int robot);
/// Stops wheels and tower as hard as they can, until the robot may go on.
void stop(MotionView& world, int robot);
/// Lets the robot go on with its command, from its present pose.
void goOn(MotionView& world, int robot);
/// Plans the present segment again from the robot's pose, after a stop or with other limits.
void replan(MotionView& world, int robot);

}  // namespace kiva
