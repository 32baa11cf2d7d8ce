// SPDX-License-Identifier: Apache-2.0
//
// Builds collisions of a description as shapes of Bullet.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <memory>
#include <string>
#include <vector>

#include "kiva_plugin_cpp/description.h"

namespace kiva {

/// Bullet's tree of the triangles of a mesh: all that stand in the world with that mesh share it.
struct TriangleTree;

/// One primitive of a body, with its model and surface: Bullet itself has one friction a body.
struct BodyPart {
  std::shared_ptr<const TriangleTree> triangles;  ///< The tree of a static mesh.
  std::unique_ptr<btCollisionShape> shape;
  int model = -1;
  double friction = 1;
  double restitution = 0;
  std::string collision;  ///< Name of its collision.
};

/// A Bullet shape with its parts.
struct BodyShape {
  std::unique_ptr<btCompoundShape> compound = std::make_unique<btCompoundShape>();
  std::vector<std::unique_ptr<BodyPart>> parts;

  /// Adds a collision of `model` at `pose` in the compound.
  void add(const Collision& collision, const btTransform& pose, int model);
};

/// Returns whether a collision has no volume in Bullet: an unbounded plane, or a mesh of a static
/// model. Such a collision is a static body of its own.
bool isSurface(const Collision& collision, bool is_static);

/// Returns a collision as a part of a body of `model`. A mesh keeps its triangles in a static model
/// and becomes its convex hull in any other.
std::unique_ptr<BodyPart> makePart(const Collision& collision, int model, bool is_static = false);

}  // namespace kiva
