// SPDX-License-Identifier: Apache-2.0
//
// The floor that robots learn on: that of warehouse_layout inside a rim of impassable cells, so
// that every neighbourhood lies on it, with its place in the world.
#pragma once

#include <vector>

#include "warehouse_layout/floor.h"
#include "warehouse_layout/layout_check.h"

namespace learning {

using layout::Deck;
using layout::kHeadings;
using layout::kNowhere;

class RimmedFloor : public layout::Floor {
 public:
  /// `description` includes the rim, which is `rim` cells wide; `stations` are the cells where
  /// units are delivered. Throws layout::FloorError as layout::Floor does.
  RimmedFloor(const layout::FloorDescription& description, int rim, const layout::Raster& raster,
              std::vector<int> stations);

  int rim() const { return rim_; }                    ///< Width of the rim [cells].
  double spacing() const { return raster_.spacing; }  ///< Edge of a cell [m].
  const std::vector<int>& stations() const { return stations_; }
  bool isStation(int cell) const { return is_station_[cell]; }

  /// Returns the longer edge without the rim [cells].
  int longest() const;
  /// Returns the difference of the next cell in that direction and a cell, wherever that lies.
  int step(int heading) const;
  /// Returns the cell, clamped to the floor's numbers: the surroundings of a robot that was pushed
  /// into the rim may lie outside.
  int inside(int cell) const;
  /// Returns the cell nearest to a point in world [m]; beyond the floor, a cell of its edge.
  int cellOf(double to_x, double to_y) const;

 private:
  int rim_;
  layout::Raster raster_;
  std::vector<int> stations_;
  std::vector<char> is_station_;  // by cell
};

/// Returns the quarter turns nearest to `yaw` [rad], 0 to 3.
int headingOf(double yaw);

}  // namespace learning
