// SPDX-License-Identifier: Apache-2.0
//
// A path of which a part is released to its robot, point by point.
#pragma once

#include <cstdint>
#include <vector>

#include "kiva_plugin_cpp/fleet.h"

namespace kiva {

/// Points are known by their numbers, counted from 0 at the beginning of the path.
struct ReleasedPath {
  std::uint32_t first = 0;        ///< Number of points[0]; those before were left, and forgotten.
  std::vector<PathPoint> points;  ///< Up to the end of the path.
  std::uint32_t released = 0;     ///< How many points of the whole path are; 0 = there is none.
  std::uint32_t origin = 0;       ///< Where the present run begins, or the robot stands.
  std::uint32_t end = 0;          ///< Where the run ends, as far as it is released.

  bool isUnderWay() const { return released > 0; }
  std::uint32_t size() const { return first + static_cast<std::uint32_t>(points.size()); }
  const PathPoint& operator[](std::uint32_t number) const { return points[number - first]; }

  /// Returns whether point `number` goes on in the direction in which those two lie, which differ
  /// along one axis.
  bool isStraight(std::uint32_t from, std::uint32_t to, std::uint32_t number) const;
  /// Lets the present run go as far as it is straight and released; one that has no length yet
  /// goes in any direction.
  void extendRun();
  /// Forgets points before `number`.
  void forgetBefore(std::uint32_t number);
};

}  // namespace kiva
