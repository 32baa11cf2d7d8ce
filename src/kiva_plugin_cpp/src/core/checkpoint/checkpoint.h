// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/checkpoint/plugin_states.h"
#include "core/state/world_state.h"

namespace kiva {

/// Returns the whole state as bytes: all that the world's future follows from.
std::string checkpoint(const WorldState& world);

/// A world read back; its plugins are still to be restored.
struct Restored {
  std::unique_ptr<WorldState> world;
  std::vector<PluginState> plugins;
};
/// Throws CheckpointError.
Restored readCheckpoint(const std::string& bytes);

/// Restores a world in place, at a fraction of the work, to the checkpoint that it was restored
/// from last, if models neither came nor went since and all that is static stands where it stood.
/// Returns false, with nothing changed, if that is not so.
bool returnTo(WorldState& world, const std::string& bytes);

std::uint64_t stateHash(const WorldState& world);

}  // namespace kiva
