// SPDX-License-Identifier: Apache-2.0
//
// Breaks and repairs parts of robots, by order or by chance. A sound fleet without failures costs a
// comparison a step.
#pragma once

#include "core/state/robots/failure_state.h"
#include "core/state/views/motion_view.h"

namespace kiva {

/// Implement World::fail, World::repair and World::lastHeard.
void injectFailure(MotionView& world, FailureState& failures, int kiva_id, Failure failure,
                   double repair_after);
void repair(MotionView& world, FailureState& failures, int kiva_id);
std::optional<RobotReport> lastHeard(const Scene& world, const FailureState& failures, int robot);

/// Repairs the robots that are due, and draws the next failures by chance, for one step of time.
void sampleFailures(MotionView& world, FailureState& failures);
/// Returns whether a part is broken, or may break by chance.
bool mayFail(const Realism& realism, const FailureState& failures);
/// Gives robots their defects again, after a checkpoint was read.
void restoreDefects(FleetState& fleet, const Realism& realism, const FailureState& failures);

}  // namespace kiva
