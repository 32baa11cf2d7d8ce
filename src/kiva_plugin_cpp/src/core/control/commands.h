// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/state/world_state.h"

namespace kiva {

/// Answers all queued commands, and gives the accepted ones to their robots.
void acceptCommands(WorldState& world);
/// Robots that were in a collision stop.
void haltCrashed(WorldState& world);

}  // namespace kiva
