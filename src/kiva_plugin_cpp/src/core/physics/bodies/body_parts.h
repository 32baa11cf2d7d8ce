// SPDX-License-Identifier: Apache-2.0
//
// Collisions of a description as shapes of Bullet.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <memory>
#include <string>
#include <vector>

#include "kiva_plugin_cpp/description.h"

namespace kiva {

/// Bullet's tree of the triangles of a mesh: all that stand in the world with that mesh share it.
struct TriangleTree;

/// One primitive of a body, whose it is, and what it is like to touch: Bullet itself knows one
/// friction a body.
struct BodyPart {
  std::shared_ptr<const TriangleTree> triangles;  ///< Of a static mesh: what its shape looks up.
  std::unique_ptr<btCollisionShape> shape;
  int model = -1;
  double friction = 1;
  double restitution = 0;
  std::string collision;  ///< Its name.
};

/// A Bullet shape with the parts it is made of.
struct BodyShape {
  std::unique_ptr<btCompoundShape> compound = std::make_unique<btCompoundShape>();
  std::vector<std::unique_ptr<BodyPart>> parts;

  /// Adds a collision's shape at `pose` in the compound, for `model`.
  void add(const Collision& collision, const btTransform& pose, int model);
};

/// Tells whether Bullet has no volume for a collision: an unbounded plane or, of a static model, a
/// mesh. Each is a static body of its own.
bool isSurface(const Collision& collision, bool is_static);

/// Returns a collision as a part of a body of `model`. A mesh keeps its triangles in a static model
/// and becomes its convex hull in any other.
std::unique_ptr<BodyPart> makePart(const Collision& collision, int model, bool is_static = false);

}  // namespace kiva
