// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "kiva_plugin_cpp/world.h"

namespace kiva {

/// The settings of a world, from its description, its options and its clients.
struct WorldSettings {
  std::string name;
  Vector3 gravity;  ///< Gravity in world [m/s²].
  WorldOptions options;
  Realism realism;  ///< Realism of the options, or else of the first robot that has it.
  bool realism_of_models = false;  ///< `realism` is from that robot.
  double grid_spacing = 1;         ///< Edge of a cell [m].

  double gravityDown() const { return -gravity.Z(); }
};

}  // namespace kiva
