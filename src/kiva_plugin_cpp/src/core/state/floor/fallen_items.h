// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kiva_plugin_cpp/description.h"

namespace kiva {

/// An item that slides off its storage unit, or lies on the floor since.
struct OffShelf {
  int item = -1, unit = -1;  ///< Models' slots.
  Vector3 velocity;       ///< Velocity at the edge relative to the unit, in the unit's frame [m/s].
  bool lies = false;      ///< It is a body of its own.
  std::uint64_t due = 0;  ///< Step of arrival at the edge; for an item that lies, step at which it
                          ///< is picked up, 0 = only by a client.
};

/// The items that have left their places.
struct FallenItems {
  std::vector<OffShelf> items;  ///< Ordered by the begin of their slides.

  /// Returns the entry of the item in that slot, or null if it did not leave its place.
  const OffShelf* find(int item) const {
    for (const OffShelf& off : items) {
      if (off.item == item) return &off;
    }
    return nullptr;
  }
};

}  // namespace kiva
