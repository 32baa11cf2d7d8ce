// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/geometry/footprint.h"

namespace kiva {

/// The pose of a footprint relative to the rays' frame, with cosine and sine [m].
struct FlatPose {
  double x = 0, y = 0, c = 1, s = 0;
};

/// Returns whether the footprint has a fixed pose in world.
bool isFixed(const Footprint& footprint);

/// Returns the distance along the horizontal ray from (x, y, z) along the unit vector (dx, dy) to a
/// surface, from outside or inside [m]; +inf = none. The surface is that of the shape with that
/// footprint at that pose, at the ray's height. A fixed footprint ignores `at`. Bodies of any form
/// are hit within `range` [m] only.
double castFootprint(const Footprint& footprint, const FlatPose& at, double x, double y, double z,
                     double dx, double dy, double range);

inline double castFootprint(const Footprint& f, double x, double y, double z, double dx, double dy,
                            double range) {
  return castFootprint(f, {f.x, f.y, f.c, f.s}, x, y, z, dx, dy, range);
}

}  // namespace kiva
