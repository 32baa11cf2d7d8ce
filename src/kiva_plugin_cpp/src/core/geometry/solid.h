// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kiva_plugin_cpp/description.h"

namespace kiva {

/// A box, cylinder, capsule or ellipsoid in any orientation, for rays.
struct Solid {
  Solid() = default;
  /// `rotation`: that of the shape, in the frame of the rays.
  Solid(const Shape& shape, const Quaternion& rotation);

  static bool canBe(Shape::Kind kind);

  /// Returns the distance [m] along the unit vector `direction` from `from`, relative to the
  /// solid's centre, to the surface, from outside or inside; +inf = none.
  double cast(const Vector3& from, const Vector3& direction) const;

  Shape::Kind kind = Shape::Kind::kBox;
  Vector3 half;  ///< Box: half the edges; ellipsoid: radii; else radius, radius, half length [m].
  Vector3 axes[3];  ///< The shape's axes in that frame.
};

}  // namespace kiva
