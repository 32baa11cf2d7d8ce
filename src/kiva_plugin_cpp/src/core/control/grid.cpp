// SPDX-License-Identifier: Apache-2.0
#include "core/control/grid.h"

#include <cmath>

namespace kiva {

double nearestGrid(const WorldSettings& settings, double coordinate) {
  return std::round(coordinate / settings.grid_spacing) * settings.grid_spacing;
}

bool isOnFloor(const Scene& world, const Point& p) {
  const double half = world.settings.grid_spacing / 2 - 1e-6;
  const FloorExtent& floor = world.floor.extent;
  return p.x - half >= floor.min_x && p.x + half <= floor.max_x && p.y - half >= floor.min_y &&
         p.y + half <= floor.max_y;
}

}  // namespace kiva
