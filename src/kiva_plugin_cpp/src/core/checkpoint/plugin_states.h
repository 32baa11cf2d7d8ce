// SPDX-License-Identifier: Apache-2.0
//
// Users' plugins in checkpoints.
#pragma once

#include <string>
#include <vector>

#include "core/state/world_state.h"

namespace kiva {

/// The state that one plugin saved.
struct PluginState {
  std::string model;  ///< Empty: a plugin of the world.
  int index = 0;      ///< Index among the plugins of that model.
  std::string state;
};

std::vector<PluginState> savePlugins(const WorldState& world);

/// Gives the models of a restored world their plugins. A plugin of the previous world is kept if
/// the same model was there; otherwise a new one is loaded. Throws DescriptionError.
void adoptPlugins(WorldState& world, const WorldState& before);
void restorePlugins(WorldState& world, const std::vector<PluginState>& states);

}  // namespace kiva
