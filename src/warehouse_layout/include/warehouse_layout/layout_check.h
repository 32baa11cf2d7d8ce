// SPDX-License-Identifier: Apache-2.0
//
// Whether loaded robots can always go on on a floor: looked at once, before anything drives.
#pragma once

#include <string>
#include <vector>

#include "warehouse_layout/floor.h"

namespace layout {

struct LayoutFault {
  enum class Kind : std::uint8_t {
    kNoAisles,  ///< there is nowhere for a loaded robot to drive
    kCutOff,    ///< cells from or to which no loaded robot can come
    kDeadEnd,   ///< edges on no cycle of three cells or more: two that meet there stay there
  };
  Kind kind;
  std::vector<Cell> cells;  ///< for kDeadEnd in pairs: from, to
};

/// What is wrong with the aisles' deck: without storage places and lanes it must be strongly
/// connected, and every edge must lie on a directed cycle of at least three cells; from every
/// storage place and lane cell there must be a way to the aisles and back. Empty: nothing.
std::vector<LayoutFault> checkLayout(const Floor& floor);

/// Where cells are: (x, y) of cell (0, 0) and the edge of a cell, for messages.
struct Raster {
  double x = 0, y = 0;
  double spacing = 1;
};

/// In a sentence, with the first cells named by where they are.
std::string describe(const LayoutFault& fault, const Floor& floor, const Raster& raster = {});

}  // namespace layout
