// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <btBulletDynamicsCommon.h>

#include <memory>

#include "kiva_plugin_cpp/description.h"

namespace kiva {

/// Bullet's tree of a mesh's triangles, which is slow to build. All models of a world with that
/// mesh share it.
struct TriangleTree {
  explicit TriangleTree(std::shared_ptr<const Mesh> of);

  /// Returns a shape on the tree, which the tree must outlive.
  std::unique_ptr<btBvhTriangleMeshShape> makeShape() const;

 private:
  std::shared_ptr<const Mesh> mesh_;  ///< Kept, so that no other mesh has its address.
  std::unique_ptr<btTriangleMesh> triangles_;
  std::unique_ptr<btBvhTriangleMeshShape> first_;  ///< Owns the tree.
};

/// Returns the tree of that mesh. Thread-safe.
std::shared_ptr<const TriangleTree> treeOf(const std::shared_ptr<const Mesh>& mesh);

}  // namespace kiva
