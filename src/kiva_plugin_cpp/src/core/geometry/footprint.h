// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/geometry/obstacles.h"
#include "kiva_plugin_cpp/description.h"

namespace kiva {

/// A box along the axes [m].
struct Bounds {
  Vector3 min{1e300, 1e300, 1e300};
  Vector3 max{-1e300, -1e300, -1e300};
  void add(const Bounds& other) {
    min.Min(other.min);
    max.Max(other.max);
  }
  bool empty() const { return min.X() > max.X(); }
};

/// Of a shape at that pose; that of a mesh bounds the box around it; a plane has its own extent and
/// no height.
Bounds bounds(const Shape& shape, const Pose& pose);
/// Of all the collisions of a model in its own frame, joints at zero.
Bounds bounds(const ModelDescription& description);

/// What a shape at that pose in world covers on the floor. Not for planes.
Footprint makeFootprint(const Shape& shape, const Pose& pose);

}  // namespace kiva
