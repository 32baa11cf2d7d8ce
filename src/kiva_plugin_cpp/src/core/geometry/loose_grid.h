// SPDX-License-Identifier: Apache-2.0
//
// The broad phase of laser scans: the boxes of all obstacles along the world's axes, in grids of
// which each level has cells of twice the size. A box is listed once, in the cell of its centre, at
// a level whose cells are at least as large as the box (a loose grid, after Ulrich's loose octrees,
// 2000). Bits tell which cells hold anything, so that a scan over an open floor reads nothing else.
#pragma once

#include <array>
#include <boost/container/small_vector.hpp>
#include <cstdint>
#include <vector>

namespace kiva {

/// A box along the world's axes [m]. Single precision: rounding keeps the order of numbers, so
/// boxes that meet also meet as rounded.
struct AxisBox {
  float min_x = 0, max_x = 0, min_y = 0, max_y = 0, min_z = 0, max_z = 0;

  bool meets(const AxisBox& o) const {
    return (min_x <= o.max_x) & (max_x >= o.min_x) & (min_y <= o.max_y) & (max_y >= o.min_y) &
           (min_z <= o.max_z) & (max_z >= o.min_z);
  }
};

class LooseGrid {
 public:
  void clear();
  /// Adds the box of a handle, or replaces it. Handles of robots are negative.
  void put(int handle, const AxisBox& box);
  void remove(int handle);

  using Handles = boost::container::small_vector<int, 64>;
  /// Appends the handle of each box that meets the area, once.
  void find(const AxisBox& area, Handles* handles) const;

 private:
  static constexpr int kLevels = 12;     // the last one has a single cell
  static constexpr float kSmallest = 2;  // cell [m]

  struct Item {
    AxisBox box;
    int handle = 0;
  };
  using Cell = boost::container::small_vector<Item, 1>;  // one item inline: most hold no more
  struct Range {                                         // inclusive
    int first = 0, last = -1;
  };
  struct Location {
    int level = -1, cell = 0, index = 0;
  };
  struct Level {
    float cell = 0;      // [m]
    float per_cell = 0;  // its inverse, which is exact: sides are powers of two
    float loose = 0;     // distance by which a box may extend beyond its cell [m]
    int width = 0, height = 0, words = 0;
    int count = 0;  // of items
    std::vector<Cell> cells;
    std::vector<std::uint64_t> occupied;  // a bit a cell, `words` a row
  };

  Range columns(const Level& level, float from, float to) const;
  Range rows(const Level& level, float from, float to) const;
  void findInRow(const Level& level, int row, const Range& columns, const AxisBox& area,
                 Handles* handles) const;
  Location& at(int handle);
  Location cellOf(const AxisBox& box) const;
  void insert(int handle, const AxisBox& box, Location* place);
  void cover(float x, float y);
  void resize(float min_x, float max_x, float min_y, float max_y);

  std::array<Level, kLevels> levels_;
  unsigned used_ = 0;                       // a bit for each level that has any box
  std::vector<Location> entries_, robots_;  // by handle, and by ~handle
  float origin_x_ = 0, origin_y_ = 0, end_x_ = 0, end_y_ = 0;  // [m]
};

}  // namespace kiva
