// SPDX-License-Identifier: Apache-2.0
//
// A laser's rays, all cast at once.
#pragma once

#include <cstdint>
#include <vector>

namespace kiva {

/// Directions of a laser's rays in the frame of its robot, as (cos, sin), evenly spread.
struct RayFan {
  int rays = 0;
  double min_angle = 0, max_angle = 0;  ///< [rad], within ±π.
  std::vector<double> c, s;
  std::vector<double> per_aside;  ///< How far a ray goes for a metre off the heading.
};

/// Where a robot's laser is, and its heading, in world.
struct Sensor {
  double x = 0, y = 0, z = 0;  ///< [m]
  double c = 1, s = 0;         ///< Cosine and sine of the heading.
};

/// How far a fan's rays are of interest [m]: each ends at `range`, or where it is `aside` off the
/// heading.
struct FanReach {
  double range = 0, aside = 0;
};

/// What each ray of a fan meets.
struct FanHits {
  std::vector<double> range;        ///< [m], where `model` is one.
  std::vector<std::int64_t> model;  ///< -1 = nothing within reach.
  int first = 0, last = -1;         ///< Others have met nothing, and are not told.
};

}  // namespace kiva
