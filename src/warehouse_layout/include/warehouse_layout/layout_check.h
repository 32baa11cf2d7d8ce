// SPDX-License-Identifier: Apache-2.0
//
// Checks, before anything drives, that loaded robots can never be stuck on a floor.
#pragma once

#include <string>
#include <vector>

#include "warehouse_layout/floor.h"

namespace layout {

/// A fault of a floor, with the cells that have it.
struct LayoutFault {
  enum class Kind : std::uint8_t {
    kNoAisles,  ///< there is nowhere for a loaded robot to drive
    kCutOff,    ///< cells that no loaded robot can reach, or not leave
    kDeadEnd,   ///< edges on no cycle of three cells or more: two robots that meet are stuck
  };
  Kind kind;
  std::vector<Cell> cells;  ///< for kDeadEnd in pairs: from, to
};

/// Returns the faults of the aisles' deck; none if it is right. Without storage places and lanes it
/// must be strongly connected, and every edge must lie on a directed cycle of at least three cells;
/// from every storage place and lane cell there must be a way to the aisles and back, and from
/// every parking place one for a robot without a load.
std::vector<LayoutFault> checkLayout(const Floor& floor);

/// The centre (x, y) [m] of cell (0, 0), and the edge of a cell [m], for messages.
struct Raster {
  double x = 0, y = 0;
  double spacing = 1;
};

/// Returns a sentence about a fault that names its first cells by their centres.
std::string describe(const LayoutFault& fault, const Floor& floor, const Raster& raster = {});

}  // namespace layout
