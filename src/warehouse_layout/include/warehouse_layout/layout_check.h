// SPDX-License-Identifier: Apache-2.0
//
// Checks, before anything drives, that loaded robots can never get stuck on a floor.
#pragma once

#include <string>
#include <vector>

#include "warehouse_layout/floor.h"

namespace layout {

/// A fault of a floor, with the cells that have it.
struct LayoutFault {
  enum class Kind : std::uint8_t {
    kNoAisles,  ///< no cell for a loaded robot to drive on
    kCutOff,    ///< cells that no loaded robot can reach, or none can leave
    kDeadEnd,   ///< edges on no cycle of three cells or more: two robots that meet are stuck
  };
  Kind kind;
  std::vector<Cell> cells;  ///< for kDeadEnd in pairs: from, to
};

/// Returns the faults of the aisles' deck; empty if there is none. Without storage places and
/// lanes, the deck must be strongly connected, and every edge must lie on a directed cycle of at
/// least three cells. There must be a way to the aisles and back from every storage place and lane
/// cell, and from every parking place for a robot without a load.
std::vector<LayoutFault> checkLayout(const Floor& floor);

/// The centre (x, y) of cell (0, 0) and the edge of a cell [m], for messages.
struct Raster {
  double x = 0, y = 0;
  double spacing = 1;
};

/// Returns a fault as a sentence that names its first cells by their centres.
std::string describe(const LayoutFault& fault, const Floor& floor, const Raster& raster = {});

}  // namespace layout
