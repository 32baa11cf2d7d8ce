// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "kiva_plugin_cpp/world.h"

namespace kiva {

/// What a world was made with, and what clients set for all of it.
struct Settings {
  std::string name;
  Vector3 gravity;  ///< In world [m/s²].
  WorldOptions options;
  Realism realism;                 ///< Given by the options, or by the first robot that has one;
  bool realism_of_models = false;  ///< true: by that robot.
  double grid_spacing = 1;         ///< Edge of a cell [m].

  double gravityDown() const { return -gravity.Z(); }
};

}  // namespace kiva
