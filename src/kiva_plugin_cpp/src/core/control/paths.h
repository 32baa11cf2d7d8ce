// SPDX-License-Identifier: Apache-2.0
//
// Released paths at the door: what is granted, and what is refused.
#pragma once

#include <cstdint>

#include "core/state/world_state.h"

namespace kiva {

/// Whether that is a change of the path that the robot is on.
bool changesPath(const WorldState& world, int robot, const FollowPath& path);
/// Gives an idle robot a path, as its command `number`. Throws Refusal, with nothing changed.
void startPath(WorldState& world, int robot, std::uint32_t number, const FollowPath& path);
/// Changes the path that the robot is on. Throws Refusal, with nothing changed.
void changePath(WorldState& world, int robot, const FollowPath& path);

}  // namespace kiva
