// SPDX-License-Identifier: Apache-2.0
//
// Numbers of the cells on which a robot can stand: on a floor that is not a full rectangle, tables
// of all cells have a word for these alone.
#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "warehouse_fleet/floor.h"

namespace fleet {

struct CellNumbers {
  std::vector<std::int32_t> of_cell;  ///< by cell: from 1 on; 0 where no robot can stand
  std::vector<Cell> cells;            ///< by number, less 1

  int words() const { return static_cast<int>(cells.size()) + 1; }
};

/// Returns the numbers of a floor; nullptr if it has few other cells, which are not worth them.
std::unique_ptr<CellNumbers> numbered(const Floor& floor);

}  // namespace fleet
