// SPDX-License-Identifier: Apache-2.0
//
// The floor of RWARE: highways, storage places and goals.
#pragma once

#include <cstdint>
#include <vector>

namespace rware {

/// Cells are numbered row by row; row 0 is at the top. x is the column, y the row.
struct Layout {
  /// `highway`: height * width, 1 = a highway, where nothing is stored. `goals`: cells, in the
  /// order in which deliveries are checked. `wall`: 1 = impassable; empty: no walls, as in RWARE.
  /// Throws std::invalid_argument if a goal lies outside or lengths differ.
  Layout(int height, int width, std::vector<std::uint8_t> highway, std::vector<int> goals,
         std::vector<std::uint8_t> wall = {});

  int size() const { return height * width; }
  int x(int cell) const { return cell % width; }
  int y(int cell) const { return cell / width; }

  bool isWall(int cell) const { return !wall.empty() && wall[cell]; }

  int height, width;
  std::vector<std::uint8_t> highway;
  std::vector<int> goals;
  std::vector<std::uint8_t> wall;
  std::vector<int> open;              ///< All cells but walls.
  std::vector<int> storage;           ///< Cells where a shelf stands at first.
  std::vector<std::uint64_t> hashes;  ///< Python's hash of each cell's (x, y).
};

}  // namespace rware
