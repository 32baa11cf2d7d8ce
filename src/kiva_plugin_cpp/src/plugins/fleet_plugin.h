// SPDX-License-Identifier: Apache-2.0
//
// The plugins that come with the world. A user's plugin is an object a model; these serve the
// whole fleet with one object each, so that a step is a loop over arrays.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "core/state/world_state.h"

namespace kiva {

class FleetPlugin {
 public:
  virtual ~FleetPlugin() = default;
  /// The file name by which an SDF asks for it.
  virtual const char* filename() const = 0;
  /// Reads one robot's parameters, before the robot joins the fleet. Throws DescriptionError.
  virtual void configure(Robot& robot, const Parameters& parameters) const = 0;
  virtual void beforeStep(WorldState& /*world*/) {}
  virtual void afterStep(WorldState& /*world*/) {}
};

/// One of each, in the order in which they act.
std::vector<std::unique_ptr<FleetPlugin>> makeFleetPlugins();

/// The plugin with that file name, or null.
const FleetPlugin* findFleetPlugin(const WorldState& world, const std::string& filename);

/// Whether `filename` names the world plugin that sets the grid.
bool isGridPlugin(const std::string& filename);
/// Reads the grid's spacing. Throws DescriptionError.
void configureGrid(WorldState& world, const Parameters& parameters);

}  // namespace kiva
