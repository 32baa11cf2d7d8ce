// SPDX-License-Identifier: Apache-2.0
//
// Casts rays in any direction, such as those of a depth camera. Level rays of lasers are faster by
// Obstacles, which has no floor.
#pragma once

#include <vector>

#include "core/geometry/footprint.h"
#include "core/geometry/solid.h"
#include "core/state/views/scene.h"

namespace kiva {

/// The collisions of all models within reach of one point. Valid until something moves.
class RayScene {
 public:
  /// `but`: a model that rays pass through, with its load; null = none.
  RayScene(const Scene& world, const Vector3& from, double range, const Model* but);

  /// Returns the distance [m] along that unit vector to the first surface; +inf = none within
  /// range.
  double cast(const Vector3& direction) const;

 private:
  struct Target {
    Bounds box;
    Vector3 centre;  ///< The centre of `solid`.
    Solid solid;
    const btCollisionObject* body = nullptr;  ///< In its place, for a shape that is no solid.
  };
  struct Plane {
    Vector3 normal;
    double height = 0;  ///< Height of the rays' origin above the plane [m].
  };
  struct Node {
    Bounds box;
    int first = 0, count = 0;  ///< Targets of a leaf.
    int right = -1;            ///< The second child, -1 in a leaf; the first one follows.
  };

  void addStatic(const Scene& world, const Model& model);
  void addMoving(const Scene& world, const Model& model);
  void addSurfaces(const Model& model);
  void add(const Shape& shape, const Pose& pose, const btCollisionObject* hull);
  void add(Target target);
  int build(int first, int count);
  double cast(const Target& target, const Vector3& direction, double range) const;

  const Vector3 from_;
  const double range_;
  std::vector<Target> targets_;
  std::vector<Plane> planes_;  ///< Surfaces without bounds.
  std::vector<Node> nodes_;
};

}  // namespace kiva
