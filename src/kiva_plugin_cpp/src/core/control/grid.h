// SPDX-License-Identifier: Apache-2.0
//
// The grid that robots drive along, and the floor beneath it.
#pragma once

#include "core/state/views/scene.h"

namespace kiva {

/// A point in world [m].
struct Point {
  double x = 0, y = 0;
  double& operator[](int axis) { return axis == 0 ? x : y; }
};

double nearestGrid(const Settings& settings, double coordinate);
/// Returns whether the whole cell around the grid point lies on the floor.
bool isOnFloor(const Scene& world, const Point& p);

}  // namespace kiva
