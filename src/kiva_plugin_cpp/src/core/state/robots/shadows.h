// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <unordered_map>

#include "kiva_plugin_cpp/fleet.h"

namespace kiva {

/// The robots that are shadows of robots elsewhere, with their reported velocities. They are no
/// part of a checkpoint: the next report makes a robot a shadow again.
struct Shadows {
  std::unordered_map<std::int32_t, PlanarTwist> twists;  ///< by the robot's id

  bool has(std::int32_t kiva_id) const { return twists.count(kiva_id) > 0; }
};

}  // namespace kiva
