// SPDX-License-Identifier: Apache-2.0
//
// What breaks in robots, by order or by chance, and is repaired. A sound fleet that is not to break
// costs a comparison a step.
#pragma once

#include "core/state/world_state.h"

namespace kiva {

/// As World::fail, World::repair and World::lastHeard say.
void breakDown(WorldState& world, int kiva_id, Failure failure, double repair_after);
void repair(WorldState& world, int kiva_id);
std::optional<RobotReport> lastHeard(const WorldState& world, int robot);

/// A step of time goes by: who is due is repaired, and what is to break by chance does.
void wearOut(WorldState& world);
/// Nothing is broken any more, and chance begins anew; nobody is told.
void beginFailures(WorldState& world);
/// Whether something is broken, or may break by chance.
bool mayFail(const WorldState& world);
/// Robots of a world that was read have what is broken in them.
void markDefects(WorldState& world);

}  // namespace kiva
