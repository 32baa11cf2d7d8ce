// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "kiva_plugin_cpp/world.h"

namespace kiva {

/// The storage units of a world and their items.
struct Storage {
  std::vector<StorageUnit> units;
  std::vector<Item> items;
  std::unordered_map<int, int> unit_of_id;  ///< Index of a unit by its number.
  std::uint64_t revision = 0;

  /// Notes that a unit, or an item that lies on none, moved or changed hands.
  void noteMove() { ++revision; }
};

}  // namespace kiva
