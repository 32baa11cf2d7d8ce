// SPDX-License-Identifier: Apache-2.0
#include "core/floor/cell_numbers.h"

namespace fleet {

std::unique_ptr<CellNumbers> numbered(const Floor& floor) {
  constexpr double kMostOfFloor = 0.75;
  auto numbers = std::make_unique<CellNumbers>();
  numbers->of_cell.resize(floor.size());
  for (Cell cell = 0; cell < floor.size(); ++cell) {
    if (!floor.isPassable(cell)) continue;
    numbers->cells.push_back(cell);
    numbers->of_cell[cell] = static_cast<std::int32_t>(numbers->cells.size());
  }
  if (numbers->words() > kMostOfFloor * floor.size()) return nullptr;
  return numbers;
}

}  // namespace fleet
