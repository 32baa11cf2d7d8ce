// SPDX-License-Identifier: Apache-2.0
//
// Carries the robots' reports to clients: at once, or by a radio that delays and loses them.
#pragma once

#include "core/state/robots/failure_state.h"
#include "core/state/views/motion_view.h"

namespace kiva {

/// Returns what the robot would report now.
RobotReport reportOf(const Scene& world, int robot);
/// Sends reports, ten times a second and when a status changes, and takes in those that have
/// arrived by now. Does nothing while the world's realism has no radio.
void deliverReports(MotionView& world);
/// Records the pose of a robot that a client has placed; the client knows it without a report.
void recordPlacement(MotionView& world, FailureState& failures, int robot);

}  // namespace kiva
