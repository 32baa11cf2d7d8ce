// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/checkpoint/rebuild.h"
#include "core/state/world_state.h"

namespace kiva {

/// Whether what was read is about one world: every index leads somewhere, what refers to each other
/// agrees, and bodies can be built of the descriptions. Throws ArchiveError with the field.
void checkConsistent(const WorldState& world, const PhysicsState& physics);

}  // namespace kiva
