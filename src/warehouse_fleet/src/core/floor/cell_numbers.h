// SPDX-License-Identifier: Apache-2.0
//
// Numbers of the cells on which a robot can stand. On a floor with many other cells, tables have a
// word for these cells alone.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "warehouse_fleet/floor.h"

namespace fleet {

struct CellNumbers {
  std::vector<std::int32_t>
      of_cell;              ///< by cell: its number, from 1 on; 0 where no robot can stand
  std::vector<Cell> cells;  ///< by number - 1

  int words() const { return static_cast<int>(cells.size()) + 1; }
};

/// Returns the numbers of a floor; nullptr if they would save too little memory.
std::unique_ptr<CellNumbers> numbered(const Floor& floor);

}  // namespace fleet
