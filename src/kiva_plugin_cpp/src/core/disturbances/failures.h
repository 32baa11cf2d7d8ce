// SPDX-License-Identifier: Apache-2.0
//
// Failures and repairs of robots, ordered or random. A fleet without failures costs a comparison a
// step.
#pragma once

#include "core/state/robots/failure_state.h"
#include "core/state/views/task_view.h"

namespace kiva {

/// Implement World::fail, World::repair and World::lastHeard.
void injectFailure(TaskView& world, FailureState& failures, int kiva_id, Failure failure,
                   double repair_after);
void repair(TaskView& world, FailureState& failures, int kiva_id);
std::optional<RobotReport> lastHeard(const Scene& world, const FailureState& failures, int robot);

/// Repairs the robots that are due, and draws the next random failures, for one step of time.
void sampleFailures(TaskView& world, FailureState& failures);
/// Draws the random failures to come from another stream: number 0 goes on with the same.
void drawFailuresAnew(TaskView& world, FailureState& failures, std::uint64_t number);
/// Returns whether a robot has a failure, or may get one at random.
bool mayFail(const Realism& realism, const FailureState& failures);
/// Gives robots their defects again, after a checkpoint was read.
void restoreDefects(FleetState& fleet, const Realism& realism, const FailureState& failures);

}  // namespace kiva
