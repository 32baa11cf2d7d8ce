// SPDX-License-Identifier: Apache-2.0
//
// Carries the robots' reports to clients: without delay, or by a radio that delays and loses them.
#pragma once

#include "core/state/robots/failure_state.h"
#include "core/state/views/task_view.h"

namespace kiva {

/// Returns the robot's present report.
RobotReport reportOf(const Scene& world, int robot);
/// Sends reports ten times a second and at each change of status, and takes those that have
/// arrived. Does nothing while the world's realism has no radio.
void deliverReports(TaskView& world);
/// Records the pose of a robot that a client has placed; the client knows it without a report.
void recordPlacement(TaskView& world, FailureState& failures, int robot);

}  // namespace kiva
