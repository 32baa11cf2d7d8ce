// SPDX-License-Identifier: Apache-2.0
//
// The floor as cells: row * width + column, of a floor with a rim of cells that no robot can enter,
// so that every neighbourhood lies inside. Headings count quarter turns from +x towards +y.
#pragma once

#include <cstdint>
#include <vector>

namespace learning {

struct Floor {
  int width = 0, height = 0;  ///< [cells], the rim included
  int rim = 0;                ///< [cells] around it
  double x = 0, y = 0;        ///< Of the centre of cell 0, in world [m].
  double spacing = 1;         ///< Edge of a cell [m].
  // By cell.
  std::vector<std::uint8_t> passable, storage, station;
  std::vector<int> stations;  ///< Cells at which units are delivered.

  int cells() const { return width * height; }
  int row(int cell) const { return cell / width; }
  int column(int cell) const { return cell % width; }
  /// The longer edge without the rim [cells].
  int longest() const;
  /// What to add to a cell for the next one in that direction.
  int step(int heading) const;
  /// A robot may have been pushed into the rim: some of what is around it lies outside.
  int inside(int cell) const;
  /// The cell nearest to a place in world [m]; of one beyond the floor, at its edge.
  int cellOf(double to_x, double to_y) const;
};

/// The quarter turns that are nearest to `yaw` [rad], 0 to 3.
int headingOf(double yaw);

}  // namespace learning
