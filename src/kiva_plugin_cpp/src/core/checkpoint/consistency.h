// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/checkpoint/rebuild.h"
#include "core/state/world_state.h"

namespace kiva {

/// Checks that the content describes one consistent world: every index is in range,
/// cross-references agree, and bodies can be built from the descriptions. Throws ArchiveError with
/// the field.
void checkConsistent(const WorldState& world, const PhysicsState& physics);

}  // namespace kiva
