// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/footprint.h"

#include <algorithm>
#include <cmath>

namespace kiva {
namespace {

constexpr double kUpright = 1 - 1e-9;  // cosine of the largest tilt that counts as none

/// Returns half extents along the world's axes.
Vector3 halfExtents(const Shape& shape, const Quaternion& rotation) {
  const Vector3 ax = rotation.XAxis(), ay = rotation.YAxis(), az = rotation.ZAxis();
  Vector3 half;
  for (int i = 0; i < 3; ++i) {
    const double round = std::sqrt(std::max(0.0, 1 - az[i] * az[i]));
    switch (shape.kind) {
      case Shape::Kind::kBox:
        half[i] = 0.5 * (std::abs(ax[i]) * shape.size.X() + std::abs(ay[i]) * shape.size.Y() +
                         std::abs(az[i]) * shape.size.Z());
        break;
      case Shape::Kind::kSphere:
        half[i] = shape.radius;
        break;
      case Shape::Kind::kCylinder:
        half[i] = std::abs(az[i]) * shape.length / 2 + round * shape.radius;
        break;
      case Shape::Kind::kCapsule:
        half[i] = std::abs(az[i]) * shape.length / 2 + shape.radius;
        break;
      case Shape::Kind::kEllipsoid:
        half[i] =
            std::sqrt(std::pow(ax[i] * shape.size.X(), 2) + std::pow(ay[i] * shape.size.Y(), 2) +
                      std::pow(az[i] * shape.size.Z(), 2));
        break;
      case Shape::Kind::kMesh: {
        const Vector3 size = shape.mesh->max - shape.mesh->min;
        half[i] = 0.5 * (std::abs(ax[i]) * size.X() + std::abs(ay[i]) * size.Y() +
                         std::abs(az[i]) * size.Z());
        break;
      }
      case Shape::Kind::kPlane:
        half[i] =
            0.5 * (std::abs(ax[i]) * shape.plane_size[0] + std::abs(ay[i]) * shape.plane_size[1]);
        break;
    }
  }
  return half;
}

/// Makes the outline of a box that stands on one of its faces: that of the other two axes. Returns
/// false if the box is tilted.
bool makeBoxOutline(const Shape& shape, const Quaternion& rotation, Footprint* out) {
  const Vector3 axes[3] = {rotation.XAxis(), rotation.YAxis(), rotation.ZAxis()};
  for (int up = 0; up < 3; ++up) {
    if (std::abs(axes[up].Z()) < kUpright) continue;
    const int along = (up + 1) % 3, across = (up + 2) % 3;
    const double length = std::hypot(axes[along].X(), axes[along].Y());
    out->kind = Footprint::Kind::kBox;
    out->c = axes[along].X() / length;
    out->s = axes[along].Y() / length;
    out->hx = shape.size[along] / 2;
    out->hy = shape.size[across] / 2;
    return true;
  }
  return false;
}

}  // namespace

Bounds bounds(const Shape& shape, const Pose& pose) {
  const Vector3 half = halfExtents(shape, pose.Rot());
  Vector3 centre = pose.Pos();
  if (shape.kind == Shape::Kind::kMesh) {
    centre = pose.CoordPositionAdd((shape.mesh->min + shape.mesh->max) * 0.5);
  }
  return {centre - half, centre + half};
}

Bounds bounds(const ModelDescription& description, const Pose& pose) {
  Bounds all;
  for (const Link& link : description.links) {
    for (const Collision& collision : link.collisions) {
      all.add(bounds(collision.shape, pose * link.pose_in_model * collision.pose_in_link));
    }
  }
  return all;
}

Footprint makeFootprint(const Shape& shape, const Pose& pose) {
  Footprint out;
  const Bounds box = bounds(shape, pose);
  out.x = (box.min.X() + box.max.X()) / 2;
  out.y = (box.min.Y() + box.max.Y()) / 2;
  out.z_min = box.min.Z();
  out.z_max = box.max.Z();
  const bool upright = std::abs(pose.Rot().ZAxis().Z()) >= kUpright;
  if (shape.kind == Shape::Kind::kBox && makeBoxOutline(shape, pose.Rot(), &out)) return out;
  if (shape.kind == Shape::Kind::kSphere || (shape.kind == Shape::Kind::kCylinder && upright)) {
    out.kind =
        shape.kind == Shape::Kind::kSphere ? Footprint::Kind::kSphere : Footprint::Kind::kCircle;
    out.hx = shape.radius;
    return out;
  }
  out.kind = Footprint::Kind::kOther;
  const Vector3 half = (box.max - box.min) * 0.5;
  out.hx = std::hypot(half.X(), half.Y());
  if (Solid::canBe(shape.kind)) out.solid = std::make_shared<Solid>(shape, pose.Rot());
  return out;
}

}  // namespace kiva
