// SPDX-License-Identifier: Apache-2.0
//
// Narrow streets of a floor whose ways lead in both directions, as between the shelves of a
// warehouse. Parallel streets are given opposite directions in turn: so robots seldom meet head on
// where they can't pass each other.
#pragma once

#include <cstdint>
#include <vector>

#include "warehouse_fleet/floor.h"

namespace fleet {

enum class StreetWay : std::uint8_t {
  kNone = 0,     ///< the edge lies in no narrow street, or leads out of it
  kAlong = 1,    ///< in the direction of its street
  kAgainst = 2,  ///< against it
};

/// Returns each edge's way by cell and heading. A street is a row of 16 passable cells or more, two
/// fifths of which have no passable cell on either side.
std::vector<StreetWay> streetWays(const Floor& floor);

}  // namespace fleet
