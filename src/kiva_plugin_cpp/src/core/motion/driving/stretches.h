// SPDX-License-Identifier: Apache-2.0
//
// Stretches: the cruise of a robot with an estimated pose. On each stretch it steers an arc by its
// odometry, while its true path deviates a little. At the end of a stretch it uses the codes that
// it read, and steers back onto its line.
#pragma once

#include "core/state/views/task_view.h"

namespace kiva {

/// Returns whether lag and errors off the line [m, rad] allow a stretch to begin.
bool isOnCourse(double lag, double heading, double across);
/// Returns whether the chassis moves as its reference, up to errors that motors correct in a step.
bool keepsUpByEstimate(const FleetState& fleet, int robot, bool turns);
/// Plans the robot's next stretch from its estimated pose. The reference follows the estimate.
void beginStretch(RobotView& world, int robot, bool turns);
/// Ends a stretch: reads a code that is due, and plans the next stretch. Returns false where the
/// robot can't cruise on, since it is lost or at its goal.
bool continueStretch(TaskView& world, int robot);

}  // namespace kiva
