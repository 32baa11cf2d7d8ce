// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
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
  std::vector<std::vector<int>> items_on;   ///< By unit: indices of its items, ascending.
  std::uint64_t revision = 0;

  /// Notes that a unit, or an item that lies on none, moved or changed hands.
  void noteMove() { ++revision; }

  /// Notes that an item lies on its unit from now on, or does no longer.
  void lay(int item) {
    if (items[item].unit < 0) return;
    std::vector<int>& on = items_on[items[item].unit];
    on.insert(std::lower_bound(on.begin(), on.end(), item), item);
  }
  void take(int item) {
    if (items[item].unit < 0) return;
    std::vector<int>& on = items_on[items[item].unit];
    on.erase(std::lower_bound(on.begin(), on.end(), item));
  }
  /// Finds the items of all units.
  void indexItems() {
    items_on.assign(units.size(), {});
    for (int i = 0; i < static_cast<int>(items.size()); ++i) lay(i);
  }
};

}  // namespace kiva
