// SPDX-License-Identifier: Apache-2.0
//
// How a robot cruises that drives by where it believes to be: in stretches on each of which it
// steers an arc by its odometry, while the robot itself goes a little elsewhere. At the end of a
// stretch it looks at what codes tell, and steers back onto its line.
#pragma once

#include "core/state/views/motion_view.h"

namespace kiva {

/// Returns whether errors [m, rad], of the reference and off the line, are small enough to begin
/// with.
bool isOnCourse(double lag, double heading, double across);
/// Returns whether the chassis moves as its reference says, but for what motors mend in a step.
bool keepsUpByEstimate(const FleetState& fleet, int robot, bool turns);
/// Plans the robot's next stretch from where it believes to be. The reference follows the estimate.
void beginStretch(MotionView& world, int robot, bool turns);
/// At the end of a stretch: reads a code that is due, plans the next one. Returns false where the
/// robot can't cruise on, being lost or at its goal.
bool continueStretch(MotionView& world, int robot);

}  // namespace kiva
