// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/geometry/footprint.h"

namespace kiva {

/// Where a footprint is and how it is turned, as cosine and sine, seen from where rays are [m].
struct FlatPose {
  double x = 0, y = 0, c = 1, s = 0;
};

/// Returns whether its pose is its own, in world, and no other.
bool isFixed(const Footprint& footprint);

/// Returns the distance along the horizontal ray from (x, y, z) along the unit vector (dx, dy) to
/// the surface of what has that footprint, is at that pose, and at the ray's height, from outside
/// or inside [m]; +inf = none. What is fixed is where it is. Bodies of any form are asked within
/// `range` [m] only.
double castFootprint(const Footprint& footprint, const FlatPose& at, double x, double y, double z,
                     double dx, double dy, double range);

inline double castFootprint(const Footprint& f, double x, double y, double z, double dx, double dy,
                            double range) {
  return castFootprint(f, {f.x, f.y, f.c, f.s}, x, y, z, dx, dy, range);
}

}  // namespace kiva
