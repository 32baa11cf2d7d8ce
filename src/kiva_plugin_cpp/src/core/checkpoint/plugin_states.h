// SPDX-License-Identifier: Apache-2.0
//
// Users' plugins in checkpoints.
#pragma once

#include <string>
#include <vector>

#include "core/state/world_state.h"

namespace kiva {

/// What one plugin saved.
struct PluginState {
  std::string model;  ///< Empty: a plugin of the world.
  int index = 0;      ///< Among the plugins of that model.
  std::string state;
};

std::vector<PluginState> savePlugins(const WorldState& world);

/// Gives restored parts of the world the plugins that they had: those of the world before it, where
/// the same model stood there, or new ones. Throws DescriptionError.
void adoptPlugins(WorldState& world, const WorldState& before);
void restorePlugins(WorldState& world, const std::vector<PluginState>& states);

}  // namespace kiva
