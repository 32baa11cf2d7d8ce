// SPDX-License-Identifier: Apache-2.0
//
// A path of which a part is released to its robot, point by point.
#pragma once

#include <cstdint>
#include <vector>

#include "kiva_plugin_cpp/fleet.h"

namespace kiva {

/// Points are numbered from 0 at the beginning of the path.
struct ReleasedPath {
  std::uint32_t first = 0;        ///< Number of points[0]; earlier points were left, and dropped.
  std::vector<PathPoint> points;  ///< Points from `first` to the end of the path.
  /// Highest speed on the way to each of `points` from the one before [m/s]; empty = no limit.
  std::vector<double> limits;
  std::uint32_t released = 0;  ///< Count of released points; 0 = no path.
  std::uint32_t origin = 0;    ///< Point at which the present run begins, or the robot stands.
  std::uint32_t end = 0;       ///< Point at which the run ends, as far as it is released.

  bool isUnderWay() const { return released > 0; }
  std::uint32_t size() const { return first + static_cast<std::uint32_t>(points.size()); }
  const PathPoint& operator[](std::uint32_t number) const { return points[number - first]; }
  bool isLimited() const { return !limits.empty(); }
  /// Returns the highest speed on the way to a point, of a path with limits [m/s].
  double limitTo(std::uint32_t number) const { return limits[number - first]; }

  /// Returns whether point `number` continues the direction of two points that differ along one
  /// axis.
  bool isStraight(std::uint32_t from, std::uint32_t to, std::uint32_t number) const;
  /// Extends the present run while it is straight and released; a run without length may take any
  /// direction.
  void extendRun();
  /// Forgets points before `number`.
  void forgetBefore(std::uint32_t number);
};

}  // namespace kiva
