// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kiva_plugin_cpp/description.h"

namespace kiva {

/// An item that slides off its storage unit, or lies on the floor since.
struct OffShelf {
  int item = -1, unit = -1;  ///< Models' slots.
  Vector3 velocity;   ///< With which it comes to the edge, as the unit moves then, in its frame.
  bool lies = false;  ///< It is a body of its own.
  std::uint64_t due = 0;  ///< The step at which it comes to the edge; of one that lies the step at
                          ///< which it is picked up, 0 = never by itself.
};

/// The items that have left their places.
struct FallenItems {
  std::vector<OffShelf> items;  ///< In the order in which they began to slide.

  /// Returns the entry of the item in that slot; null: it is on its unit, or never was.
  const OffShelf* find(int item) const {
    for (const OffShelf& one : items) {
      if (one.item == item) return &one;
    }
    return nullptr;
  }
};

}  // namespace kiva
