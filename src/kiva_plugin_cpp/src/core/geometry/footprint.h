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

/// The outline of an upright shape on the floor, and its range of heights. In world [m].
struct Footprint {
  enum class Kind : std::uint8_t {
    kBox,       ///< Rectangle hx × hy, turned by (c, s).
    kCircle,    ///< An upright cylinder of radius hx.
    kSphere,    ///< A sphere of radius hx; narrower above and below its middle.
    kTriangle,  ///< `triangle`, within a rectangle hx × hy along the world's axes.
    kOther      ///< Bounded by a circle of radius hx; rays are cast at `solid` or `body`.
  };
  Kind kind = Kind::kBox;
  double x = 0, y = 0;
  double c = 1, s = 0;
  double hx = 0, hy = 0;
  double z_min = 0, z_max = 0;
  int model = -1;  ///< Index of its owner in the world's models.
  int group =
      -1;  ///< Index of a robot, for the robot and its load; rays of that robot pass through.
  std::shared_ptr<const Solid> solid;       ///< For kOther: centred on the footprint, in its frame.
  const btCollisionObject* body = nullptr;  ///< For kOther; null: the circle is exact.
  const std::array<Vector3, 3>* triangle = nullptr;  ///< Corners, for kTriangle.
};

/// Returns the length of a vector of some metres: std::hypot, which guards against overflow, takes
/// five times as long.
inline double lengthOf(double x, double y) { return std::sqrt(x * x + y * y); }

/// Sets `world` to the pose of `local`, which is in a frame at (x, y) rotated by (c, s).
inline void place(const Footprint& local, double x, double y, double c, double s,
                  Footprint* world) {
  world->x = x + c * local.x - s * local.y;
  world->y = y + s * local.x + c * local.y;
  world->c = c * local.c - s * local.s;
  world->s = s * local.c + c * local.s;
}

/// Does the same for each of several footprints.
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

/// Returns the radius of the circle around (x, y) that contains it [m].
inline double radiusOf(const Footprint& f) {
  const bool round = f.kind != Footprint::Kind::kBox && f.kind != Footprint::Kind::kTriangle;
  return round ? f.hx : lengthOf(f.hx, f.hy);
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

/// Returns the bounds of a shape at that pose. Those of a mesh bound its box; a plane has its own
/// extent and no height.
Bounds bounds(const Shape& shape, const Pose& pose);
/// Returns the bounds of all collisions of a model at that pose, joints at zero.
Bounds bounds(const ModelDescription& description, const Pose& pose = Pose());

/// Returns the footprint of a shape at that pose in world. Not for planes.
Footprint makeFootprint(const Shape& shape, const Pose& pose);

}  // namespace kiva
