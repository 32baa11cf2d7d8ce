// SPDX-License-Identifier: Apache-2.0
//
// The floor that robots learn on: that of warehouse_layout, inside a rim of cells that no robot can
// enter, so that every neighbourhood lies on it; and where it is in the world.
#pragma once

#include <vector>

#include "warehouse_layout/floor.h"
#include "warehouse_layout/layout_check.h"

namespace learning {

using layout::Deck;
using layout::kHeadings;
using layout::kNowhere;

class Floor : public layout::Floor {
 public:
  /// The description includes the rim, so many cells wide; `stations` are cells at which units are
  /// delivered. Throws layout::FloorError as layout::Floor does.
  Floor(const layout::FloorDescription& description, int rim, const layout::Raster& raster,
        std::vector<int> stations);

  int rim() const { return rim_; }                    ///< [cells] around it
  double spacing() const { return raster_.spacing; }  ///< Edge of a cell [m].
  const std::vector<int>& stations() const { return stations_; }
  bool isStation(int cell) const { return is_station_[cell]; }

  /// The longer edge without the rim [cells].
  int longest() const;
  /// What to add to a cell for the next one in that direction, wherever that lies.
  int step(int heading) const;
  /// The cell itself, or the nearest number of one: a robot may have been pushed into the rim, and
  /// some of what is around it lies outside.
  int inside(int cell) const;
  /// The cell nearest to a place in world [m]; of one beyond the floor, at its edge.
  int cellOf(double to_x, double to_y) const;

 private:
  int rim_;
  layout::Raster raster_;
  std::vector<int> stations_;
  std::vector<char> is_station_;  // by cell
};

/// The quarter turns that are nearest to `yaw` [rad], 0 to 3.
int headingOf(double yaw);

}  // namespace learning
