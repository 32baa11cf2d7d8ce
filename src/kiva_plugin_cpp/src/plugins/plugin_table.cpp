// SPDX-License-Identifier: Apache-2.0
#include "plugins/fleet_plugin.h"
#include "plugins/laser.h"
#include "plugins/lift.h"
#include "plugins/motion.h"
#include "plugins/rotation.h"

namespace kiva {

std::vector<std::unique_ptr<FleetPlugin>> makeFleetPlugins() {
  std::vector<std::unique_ptr<FleetPlugin>> table;
  table.push_back(std::make_unique<MotionPlugin>());
  table.push_back(std::make_unique<RotationPlugin>());
  table.push_back(std::make_unique<LiftPlugin>());
  table.push_back(std::make_unique<LaserPlugin>());
  return table;
}

const FleetPlugin* findFleetPlugin(const WorldState& world, const std::string& filename) {
  for (const auto& plugin : world.fleet_plugins) {
    if (filename == plugin->filename()) return plugin.get();
  }
  return nullptr;
}

bool isGridPlugin(const std::string& filename) { return filename == "libkiva_grid.so"; }

void configureGrid(WorldState& world, const Parameters& parameters) {
  world.grid_spacing = parameters.number("spacing", 1.0, 0.1, 100.0);
}

}  // namespace kiva
