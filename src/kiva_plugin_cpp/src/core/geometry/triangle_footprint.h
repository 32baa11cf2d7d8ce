// SPDX-License-Identifier: Apache-2.0
//
// The geometry of a static mesh is that of its single triangles: a building is hollow, and objects
// that hang from its roof block no robot.
#pragma once

#include <array>

#include "core/geometry/footprint.h"
#include "kiva_plugin_cpp/description.h"

namespace kiva {

/// Corners in world [m].
using Triangle = std::array<Vector3, 3>;

/// Returns a triangle of a mesh at that pose in world.
Triangle cornersOf(const Mesh& mesh, int triangle, const Pose& pose);

/// Returns its footprint. The triangle must outlive the footprint.
Footprint makeFootprint(const Triangle& triangle);

/// Returns the distance at which the horizontal ray from (x, y, z) along the unit vector (dx, dy)
/// meets the triangle from either side [m]; +inf = not at all.
double castTriangle(const Triangle& triangle, double x, double y, double z, double dx, double dy);

/// Returns a lower bound of the distance between the triangle, seen from above, and another
/// footprint [m]; negative where they overlap.
double gapToTriangle(const Triangle& triangle, const Footprint& other);

}  // namespace kiva
