// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "core/checkpoint/plugin_states.h"
#include "core/state/world_state.h"

namespace kiva {

/// Returns the whole state as bytes: all that determines the world's future.
std::string checkpoint(const WorldState& world);

/// A restored world whose plugins are not restored yet.
struct Restored {
  std::unique_ptr<WorldState> world;
  std::vector<PluginState> plugins;
};
/// Throws CheckpointError.
Restored readCheckpoint(const std::string& bytes);

/// Restores a world in place to the checkpoint from which it was last restored, at a fraction of
/// the work. This requires that since then no model was added or removed and nothing static has
/// moved. Returns false, with nothing changed, if that does not hold.
bool returnTo(WorldState& world, const std::string& bytes);

std::uint64_t stateHash(const WorldState& world);

}  // namespace kiva
