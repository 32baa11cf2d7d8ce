// SPDX-License-Identifier: Apache-2.0
#include "floor.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

namespace learning {
namespace {

constexpr double kQuarterTurn = 1.5707963267948966;  // [rad]

/// Returns the cell of a row or column nearest to `way` [cells] from the first.
int nearest(double way, int cells) {
  const double rounded = std::nearbyint(way);
  return rounded > 0 ? static_cast<int>(std::min(rounded, cells - 1.0)) : 0;
}

}  // namespace

RimmedFloor::RimmedFloor(const layout::FloorDescription& description, int rim,
                         const layout::Raster& raster, std::vector<int> stations)
    : layout::Floor(description),
      rim_(rim),
      raster_(raster),
      stations_(std::move(stations)),
      is_station_(size()) {
  for (const int cell : stations_) is_station_[cell] = 1;
}

int RimmedFloor::longest() const { return std::max(width(), height()) - 2 * rim_; }

int RimmedFloor::step(int heading) const {
  const int steps[] = {1, width(), -1, -width()};
  return steps[heading & 3];
}

int RimmedFloor::inside(int cell) const { return std::clamp(cell, 0, size() - 1); }

int RimmedFloor::cellOf(double to_x, double to_y) const {
  return nearest((to_y - raster_.y) / raster_.spacing, height()) * width() +
         nearest((to_x - raster_.x) / raster_.spacing, width());
}

int headingOf(double yaw) {
  return static_cast<int>(static_cast<std::int64_t>(std::nearbyint(yaw / kQuarterTurn)) & 3);
}

}  // namespace learning
