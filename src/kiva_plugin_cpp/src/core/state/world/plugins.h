// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

#include "kiva_plugin_cpp/plugin.h"

namespace kiva {

class FleetPlugin;
class World;

/// The plugins of a world that belong to no model.
struct Plugins {
  World* owner = nullptr;                                 ///< What all plugins are loaded into.
  std::vector<std::shared_ptr<const FleetPlugin>> fleet;  ///< Those that come with the world.
  std::vector<std::shared_ptr<Plugin>> world;
  std::vector<PluginDescription> world_descriptions;  ///< Descriptions of those, in the same order.
};

}  // namespace kiva
