// SPDX-License-Identifier: Apache-2.0
//
// What breaks in robots, by order or by chance, and is repaired. A sound fleet that is not to break
// costs a comparison a step.
#pragma once

#include "core/state/failure_state.h"
#include "core/state/motion_view.h"

namespace kiva {

/// As World::fail, World::repair and World::lastHeard say.
void breakDown(MotionView& world, FailureState& failures, int kiva_id, Failure failure,
               double repair_after);
void repair(MotionView& world, FailureState& failures, int kiva_id);
std::optional<RobotReport> lastHeard(const Scene& world, const FailureState& failures, int robot);

/// A step of time goes by: who is due is repaired, and what is to break by chance does.
void wearOut(MotionView& world, FailureState& failures);
/// Whether something is broken, or may break by chance.
bool mayFail(const Realism& realism, const FailureState& failures);
/// Robots of a world that was read have what is broken in them.
void markDefects(FleetState& fleet, const Realism& realism, const FailureState& failures);

}  // namespace kiva
