// SPDX-License-Identifier: Apache-2.0
//
// The way of what robots report to who listens: at once, or as a radio brings it, late or not at
// all.
#pragma once

#include "core/state/failure_state.h"
#include "core/state/motion_view.h"

namespace kiva {

/// What the robot would report now.
RobotReport reportOf(const Scene& world, int robot);
/// Robots report ten times a second, and when their status changes; takes in what has come by now.
/// Nothing while the world's realism has no radio.
void exchangeReports(MotionView& world);
/// Whoever has put a robot somewhere knows where it is, heard or not.
void knowWhereabouts(MotionView& world, FailureState& failures, int robot);

}  // namespace kiva
