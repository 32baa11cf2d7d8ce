// SPDX-License-Identifier: Apache-2.0
//
// A laser's rays, cast together.
#pragma once

#include <cstdint>
#include <vector>

namespace kiva {

/// Directions of a laser's rays in its robot's frame, as (cos, sin), evenly spaced.
struct RayFan {
  int rays = 0;
  double min_angle = 0, max_angle = 0;  ///< [rad], within ±π.
  std::vector<double> c, s;
  std::vector<double> per_aside;  ///< Length of a ray for a metre to the side of the heading.
};

/// The pose of a robot's laser in world.
struct Sensor {
  double x = 0, y = 0, z = 0;  ///< [m]
  double c = 1, s = 0;         ///< Cosine and sine of the heading.
};

/// The reach of a fan's rays [m]: each ends at `range`, or at the distance `aside` from the
/// heading's line.
struct FanReach {
  double range = 0, aside = 0;
};

/// The hit of each ray of a fan.
struct FanHits {
  std::vector<double> range;        ///< [m], valid if `model` is.
  std::vector<std::int64_t> model;  ///< -1 = nothing within reach.
  int first = 0, last = -1;         ///< Range of rays that may have hits; others are not written.
};

}  // namespace kiva
