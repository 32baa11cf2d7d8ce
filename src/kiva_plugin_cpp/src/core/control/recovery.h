// SPDX-License-Identifier: Apache-2.0
//
// How a robot that was pushed or stopped off the grid gets back to it.
#pragma once

#include <vector>

#include "core/control/grid.h"

namespace kiva {

/// Straight from a pose to a point, by the smaller turn, forwards or backwards.
struct StraightWay {
  double heading = 0;  ///< Of the robot on it [rad].
  double length = 0;   ///< [m]; < 0 = in reverse.
};
StraightWay straightWay(const PlanarPose& from, const Point& to);

/// The points that the robot drives to straight, one after the other, turning before each: the last
/// is a free grid point, `back` if it can be that. On its way it touches no leg of a storage unit,
/// or pushes it but a little. Empty: there is no such way.
std::vector<Point> wayBack(const Scene& world, int robot, const Point* back);

}  // namespace kiva
