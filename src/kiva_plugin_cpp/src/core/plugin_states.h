// SPDX-License-Identifier: Apache-2.0
//
// Users' plugins in checkpoints.
#pragma once

#include <string>
#include <vector>

#include "parts.h"

namespace kiva {

/// What one plugin saved.
struct PluginState {
  std::string model;  ///< Empty: a plugin of the world.
  int index = 0;      ///< Among the plugins of that model.
  std::string state;
};

std::vector<PluginState> savePlugins(const Parts& parts);

/// Gives restored parts the plugins that they had: those of the world before it, where the same
/// model stood there, or new ones. Throws DescriptionError.
void adoptPlugins(Parts& parts, const Parts& before);
void restorePlugins(Parts& parts, const std::vector<PluginState>& states);

}  // namespace kiva
