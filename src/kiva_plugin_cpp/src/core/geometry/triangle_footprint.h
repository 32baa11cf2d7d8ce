// SPDX-License-Identifier: Apache-2.0
//
// The geometry of a static mesh is that of its triangles, one by one: a building is hollow, and
// what hangs from its roof is in no robot's way.
#pragma once

#include <array>

#include "core/geometry/footprint.h"
#include "kiva_plugin_cpp/description.h"

namespace kiva {

/// Corners in world [m].
using Triangle = std::array<Vector3, 3>;

/// One of a mesh that stands at that pose in world.
Triangle cornersOf(const Mesh& mesh, int triangle, const Pose& pose);

/// Returns what it covers on the floor. The triangle must outlive the footprint.
Footprint makeFootprint(const Triangle& triangle);

/// Returns the distance along the horizontal ray from (x, y, z) along the unit vector (dx, dy) at
/// which it meets the triangle from either side [m]; +inf = not at all.
double castTriangle(const Triangle& triangle, double x, double y, double z, double dx, double dy);

/// Returns a lower bound of the distance between the triangle, seen from above, and another
/// geometry [m]; negative where they overlap.
double gapToTriangle(const Triangle& triangle, const Footprint& other);

}  // namespace kiva
