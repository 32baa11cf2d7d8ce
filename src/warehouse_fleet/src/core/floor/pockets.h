// SPDX-License-Identifier: Apache-2.0
//
// Parts of a floor that lie behind a single cell: dead ends, and rooms at the end of a passage.
#pragma once

#include <cstdint>
#include <vector>

#include "warehouse_fleet/floor.h"

namespace fleet {

/// Returns the cells beside one that a robot without a load can drive to.
std::vector<Cell> neighbours(const Floor& floor, Cell cell);

/// Returns by cell whether it lies in a pocket: a part of at most `most` cells, and of a third of
/// all at most, that taking a single cell away cuts off from the rest. Found by lowest numbers
/// reached in a depth-first search (Hopcroft and Tarjan, 1973).
std::vector<std::uint8_t> pockets(const Floor& floor, int most);

}  // namespace fleet
