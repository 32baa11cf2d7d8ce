// SPDX-License-Identifier: Apache-2.0
#include "core/physics/bodies/body_parts.h"

#include <BulletCollision/CollisionShapes/btConvexPolyhedron.h>
#include <LinearMath/btConvexHullComputer.h>

#include <array>
#include <map>
#include <new>
#include <vector>

#include "core/physics/bodies/conversions.h"
#include "core/physics/bodies/triangle_tree.h"

namespace kiva {
namespace {

// Margin by which GJK shrinks a shape and rounds its edges; the error of contacts is less than half
// of it.
constexpr double kMargin = 0.0002;  // [m]

// Distance at which Bullet itself foresees contacts.
constexpr double kForesight = 0.02;  // [m]

/// A shape whose bounding box is padded by that distance. Bullet compares bare boxes within
/// compounds, and a fast body would sink in before its parts are tested.
template <typename Base>
class Foreseeing : public Base {
 public:
  using Base::Base;
  void getAabb(const btTransform& pose, btVector3& min, btVector3& max) const override {
    Base::getAabb(pose, min, max);
    min -= btVector3(kForesight, kForesight, kForesight);
    max += btVector3(kForesight, kForesight, kForesight);
  }
};

/// A box that computes its faces once for all boxes of that size. A body is rebuilt whenever it
/// comes near another, and needs its faces as soon as they may touch.
class FacetedBox : public Foreseeing<btBoxShape> {
 public:
  using Foreseeing<btBoxShape>::Foreseeing;
  bool initializePolyhedralFeatures(int shift) override {
    if (shift != 0) return btBoxShape::initializePolyhedralFeatures(shift);
    if (!m_polyhedron) {
      void* memory = btAlignedAlloc(sizeof(btConvexPolyhedron), 16);
      m_polyhedron = new (memory) btConvexPolyhedron(faces());
    }
    return true;
  }

 private:
  const btConvexPolyhedron& faces() const {
    constexpr std::size_t kMostSizes = 1000;
    static thread_local std::map<std::array<btScalar, 3>, btBoxShape> known;
    if (known.size() >= kMostSizes) known.clear();
    const btVector3 half = getHalfExtentsWithMargin();
    const auto [at, is_new] = known.try_emplace({half.x(), half.y(), half.z()}, *this);
    if (is_new) at->second.initializePolyhedralFeatures();
    return *at->second.getConvexPolyhedron();
  }
};

std::unique_ptr<btCollisionShape> makeBox(const Shape& shape) {
  auto box = std::make_unique<FacetedBox>(toBullet(shape.size * 0.5));
  box->setMargin(kMargin);
  return box;
}

std::unique_ptr<btCollisionShape> makeCylinder(const Shape& shape) {
  const btVector3 half(shape.radius, shape.radius, shape.length / 2);
  auto cylinder = std::make_unique<Foreseeing<btCylinderShapeZ>>(half);
  cylinder->setMargin(kMargin);
  return cylinder;
}

std::unique_ptr<btCollisionShape> makeEllipsoid(const Shape& shape) {
  const btVector3 centre(0, 0, 0);
  const btScalar unit = 1;
  auto ellipsoid = std::make_unique<Foreseeing<btMultiSphereShape>>(&centre, &unit, 1);
  ellipsoid->setLocalScaling(toBullet(shape.size));
  return ellipsoid;
}

/// Returns the convex hull of a movable mesh.
std::unique_ptr<btCollisionShape> makeHull(const Mesh& mesh) {
  std::vector<btVector3> points;
  for (const Vector3& vertex : mesh.vertices) points.push_back(toBullet(vertex));
  btConvexHullComputer computer;
  computer.compute(&points[0].x(), sizeof(btVector3), static_cast<int>(points.size()), 0, 0);
  auto hull = std::make_unique<Foreseeing<btConvexHullShape>>();
  for (int i = 0; i < computer.vertices.size(); ++i) hull->addPoint(computer.vertices[i], false);
  hull->recalcLocalAabb();
  hull->setMargin(kMargin);
  return hull;
}

/// Sets the triangles of a static mesh.
void setTriangles(const std::shared_ptr<const Mesh>& mesh, BodyPart* part) {
  part->triangles = treeOf(mesh);
  part->shape = part->triangles->makeShape();
  part->shape->setMargin(kMargin);
}

std::unique_ptr<btCollisionShape> makeShape(const Shape& shape) {
  switch (shape.kind) {
    case Shape::Kind::kBox:
      return makeBox(shape);
    case Shape::Kind::kSphere:
      return std::make_unique<Foreseeing<btSphereShape>>(shape.radius);
    case Shape::Kind::kCylinder:
      return makeCylinder(shape);
    case Shape::Kind::kCapsule:
      return std::make_unique<Foreseeing<btCapsuleShapeZ>>(shape.radius, shape.length);
    case Shape::Kind::kEllipsoid:
      return makeEllipsoid(shape);
    case Shape::Kind::kPlane:
      return std::make_unique<btStaticPlaneShape>(toBullet(shape.normal), 0);
    case Shape::Kind::kMesh:
      return makeHull(*shape.mesh);
  }
  return nullptr;
}

}  // namespace

bool isSurface(const Collision& collision, bool is_static) {
  const Shape::Kind kind = collision.shape.kind;
  return kind == Shape::Kind::kPlane || (kind == Shape::Kind::kMesh && is_static);
}

std::unique_ptr<BodyPart> makePart(const Collision& collision, int model, bool is_static) {
  auto part = std::make_unique<BodyPart>();
  if (collision.shape.kind == Shape::Kind::kMesh && is_static) {
    setTriangles(collision.shape.mesh, part.get());
  } else {
    part->shape = makeShape(collision.shape);
  }
  part->shape->setUserPointer(part.get());
  part->model = model;
  part->friction = collision.friction;
  part->restitution = collision.restitution;
  part->collision = collision.name;
  return part;
}

void BodyShape::add(const Collision& collision, const btTransform& pose, int model) {
  parts.push_back(makePart(collision, model));
  compound->addChildShape(pose, parts.back()->shape.get());
}

}  // namespace kiva
