// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/state/world_state.h"

namespace kiva {

/// Reports each contact that should not be once, when its impact is over, and stops the robots in
/// it.
void reportCollisions(WorldState& world);
/// Forgets a model that is going, -1 = all; what has not been told yet is.
void forgetContacts(WorldState& world, int slot);

}  // namespace kiva
