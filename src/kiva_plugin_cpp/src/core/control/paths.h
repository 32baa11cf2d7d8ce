// SPDX-License-Identifier: Apache-2.0
//
// Grants or refuses released paths, and changes of them.
#pragma once

#include <cstdint>

#include "core/state/views/motion_view.h"

namespace kiva {

/// Returns whether a message changes the path that the robot follows.
bool changesPath(const FleetState& fleet, int robot, const FollowPath& path);
/// Gives an idle robot a path, as its command `number`. Throws Refusal, with nothing changed.
void startPath(TaskView& world, int robot, std::uint32_t number, const FollowPath& path);
/// Changes the path that the robot follows. Throws Refusal, with nothing changed.
void changePath(TaskView& world, Obstacles& obstacles, int robot, const FollowPath& path);

}  // namespace kiva
