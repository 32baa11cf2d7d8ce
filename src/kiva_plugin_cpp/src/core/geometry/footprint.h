// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "core/geometry/solid.h"
#include "kiva_plugin_cpp/description.h"

class btCollisionObject;

namespace kiva {

/// The outline of an upright shape on the floor and the heights it spans. In world [m].
struct Footprint {
  enum class Kind : std::uint8_t {
    kBox,       ///< Rectangle hx × hy, turned by (c, s).
    kCircle,    ///< An upright cylinder of radius hx.
    kSphere,    ///< A sphere of radius hx; narrower off its middle height.
    kTriangle,  ///< `triangle`, within a rectangle hx × hy along the world's axes.
    kOther      ///< Bounded by a circle of radius hx; a ray asks `solid` or `body` for the truth.
  };
  Kind kind = Kind::kBox;
  double x = 0, y = 0;
  double c = 1, s = 0;
  double hx = 0, hy = 0;
  double z_min = 0, z_max = 0;
  int model = -1;  ///< Whose it is: index in the world's models.
  int group = -1;  ///< Robot index for a robot and what it carries; rays of that robot pass.
  std::shared_ptr<const Solid> solid;       ///< For kOther: centred on the footprint, in its frame.
  const btCollisionObject* body = nullptr;  ///< For kOther; null: the circle is the truth.
  const std::array<Vector3, 3>* triangle = nullptr;  ///< Corners, for kTriangle.
};

/// Moves `world` to where `local`, in a frame at (x, y) turned by (c, s), is.
inline void place(const Footprint& local, double x, double y, double c, double s,
                  Footprint* world) {
  world->x = x + c * local.x - s * local.y;
  world->y = y + s * local.x + c * local.y;
  world->c = c * local.c - s * local.s;
  world->s = s * local.c + c * local.s;
}

/// The same for each of several.
inline void placeAll(const std::vector<Footprint>& local, double x, double y, double yaw,
                     std::vector<Footprint>* world) {
  const double c = std::cos(yaw), s = std::sin(yaw);
  for (std::size_t k = 0; k < local.size(); ++k) place(local[k], x, y, c, s, &(*world)[k]);
}

inline Footprint circleAt(double x, double y, double radius) {
  Footprint circle;
  circle.kind = Footprint::Kind::kCircle;
  circle.x = x;
  circle.y = y;
  circle.hx = radius;
  return circle;
}

/// Returns the radius of the circle around (x, y) that holds it [m].
inline double radiusOf(const Footprint& f) {
  const bool round = f.kind != Footprint::Kind::kBox && f.kind != Footprint::Kind::kTriangle;
  return round ? f.hx : std::sqrt(f.hx * f.hx + f.hy * f.hy);
}

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

/// Returns the bounds of a shape at that pose; that of a mesh bounds the box around it; a plane has
/// its own extent and no height.
Bounds bounds(const Shape& shape, const Pose& pose);
/// Returns the bounds of all collisions of a model at that pose, joints at zero.
Bounds bounds(const ModelDescription& description, const Pose& pose = Pose());

/// Returns what a shape at that pose in world covers on the floor. Not for planes.
Footprint makeFootprint(const Shape& shape, const Pose& pose);

}  // namespace kiva
