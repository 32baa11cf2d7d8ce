// SPDX-License-Identifier: Apache-2.0
#include "core/physics/bodies/triangle_tree.h"

#include <map>
#include <mutex>

namespace kiva {

TriangleTree::TriangleTree(std::shared_ptr<const Mesh> of)
    : mesh_(std::move(of)), triangles_(std::make_unique<btTriangleMesh>()) {
  for (const Vector3& vertex : mesh_->vertices) {
    triangles_->findOrAddVertex(btVector3(vertex.X(), vertex.Y(), vertex.Z()), false);
  }
  for (const auto& [a, b, c] : mesh_->triangles) triangles_->addTriangleIndices(a, b, c);
  first_ = std::make_unique<btBvhTriangleMeshShape>(triangles_.get(), true);
  // Set in advance: otherwise each shape would compute its box from all triangles.
  triangles_->setPremadeAabb(first_->getLocalAabbMin(), first_->getLocalAabbMax());
}

std::unique_ptr<btBvhTriangleMeshShape> TriangleTree::makeShape() const {
  auto shape = std::make_unique<btBvhTriangleMeshShape>(triangles_.get(), true, false);
  shape->setOptimizedBvh(first_->getOptimizedBvh());
  return shape;
}

std::shared_ptr<const TriangleTree> treeOf(const std::shared_ptr<const Mesh>& mesh) {
  static std::mutex mutex;
  static std::map<const Mesh*, std::weak_ptr<const TriangleTree>> known;
  const std::lock_guard<std::mutex> lock(mutex);
  for (auto at = known.begin(); at != known.end();) {
    at = at->second.expired() ? known.erase(at) : std::next(at);
  }
  auto tree = known[mesh.get()].lock();
  if (!tree) known[mesh.get()] = tree = std::make_shared<const TriangleTree>(mesh);
  return tree;
}

}  // namespace kiva
