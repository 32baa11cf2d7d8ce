// SPDX-License-Identifier: Apache-2.0
//
// Searches the way back to the grid for a robot that was pushed off it or stopped off it.
#pragma once

#include <vector>

#include "core/control/grid.h"

namespace kiva {

/// The straight way from a pose to a point, by the smaller turn, forwards or backwards.
struct StraightWay {
  double heading = 0;  ///< Heading of the robot on that way [rad].
  double length = 0;   ///< [m]; < 0 = in reverse.
};
StraightWay straightWay(const PlanarPose& from, const Point& to);

/// Returns the points to which the robot drives straight, one after the other, turning before each.
/// The last point is a free grid point, `back` if possible. On its way the robot touches no leg of
/// a storage unit, or pushes it only slightly. Empty if there is no such way.
std::vector<Point> findWayBack(const Scene& world, int robot, const Point* back);

}  // namespace kiva
