// SPDX-License-Identifier: Apache-2.0
//
// Parts of a floor that lie behind a single cell: dead ends, and rooms at the end of a passage.
#pragma once

#include <cstdint>
#include <vector>

#include "warehouse_fleet/floor.h"

namespace fleet {

/// Returns the neighbours of a cell to which a robot without a load can drive.
std::vector<Cell> neighbours(const Floor& floor, Cell cell);

/// Returns by cell whether it lies in a pocket: a part of at most `most` cells and a third of all,
/// which the removal of a single cell cuts off. Computed by low numbers of a depth-first search
/// (Hopcroft and Tarjan, 1973).
std::vector<std::uint8_t> pockets(const Floor& floor, int most);

}  // namespace fleet
