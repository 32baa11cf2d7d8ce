// SPDX-License-Identifier: Apache-2.0
#include "core/physics/collision/box_contacts.h"

#include <BulletCollision/CollisionDispatch/btBoxBoxDetector.h>
#include <BulletCollision/CollisionShapes/btConvexPolyhedron.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPolyhedralContactClipping.h>

#include <algorithm>
#include <new>

namespace kiva {
namespace {

using Input = btDiscreteCollisionDetectorInterface::ClosestPointInput;

// Largest error of GJK's distances.
constexpr btScalar kGjkExact = 1e-4;  // [m]

// Distance up to which boxes may lie on each other, and keep the impulses between them.
constexpr btScalar kTouches = 1e-3;  // [m]

/// The closest points of two shapes that are apart.
struct Closest : btDiscreteCollisionDetectorInterface::Result {
  void setShapeIdentifiersA(int, int) override {}
  void setShapeIdentifiersB(int, int) override {}
  void addContactPoint(const btVector3& normal_on_b, const btVector3& point_on_b,
                       btScalar apart) override {
    is_found = true;
    normal = normal_on_b;
    point = point_on_b;
    distance = apart;
  }
  bool is_found = false;
  btVector3 normal, point;
  btScalar distance = 0;
};

/// Passes contacts on, and notes whether there was any.
struct Counting : btDiscreteCollisionDetectorInterface::Result {
  explicit Counting(btManifoldResult& result) : out(result) {}
  void setShapeIdentifiersA(int part, int index) override { out.setShapeIdentifiersA(part, index); }
  void setShapeIdentifiersB(int part, int index) override { out.setShapeIdentifiersB(part, index); }
  void addContactPoint(const btVector3& normal, const btVector3& point,
                       btScalar distance) override {
    out.addContactPoint(normal, point, distance);
    ++count;
  }
  btManifoldResult& out;
  int count = 0;
};

const btBoxShape* boxOf(const btCollisionObjectWrapper* wrapper) {
  return static_cast<const btBoxShape*>(wrapper->getCollisionShape());
}

/// Returns faces and edges of the box. Few boxes ever come so near to another that they need them.
const btConvexPolyhedron& polyhedronOf(const btBoxShape* box) {
  if (!box->getConvexPolyhedron()) {
    const_cast<btBoxShape*>(box)->initializePolyhedralFeatures();
  }
  return *box->getConvexPolyhedron();
}

/// Drops contacts foreseen in the last step. Where boxes turn fast, an old normal lets corners
/// touch that pass each other.
void forgetForeseen(btPersistentManifold& manifold) {
  for (int i = manifold.getNumContacts(); i-- > 0;) {
    if (manifold.getContactPoint(i).getDistance() > kTouches) manifold.removeContactPoint(i);
  }
}

/// Returns whether the boxes are farther apart than `distance` along one of their axes, which holds
/// for most of those that are near.
bool areFarther(btScalar distance, const btBoxShape* a, const btBoxShape* b, const Input& input) {
  const btMatrix3x3 turn =
      input.m_transformA.getBasis().transposeTimes(input.m_transformB.getBasis());
  const btVector3 way = input.m_transformB.getOrigin() - input.m_transformA.getOrigin();
  const btVector3 from_a = way * input.m_transformA.getBasis();  // in its frame
  const btVector3 from_b = way * input.m_transformB.getBasis();
  const btMatrix3x3 extent = turn.absolute();
  const btVector3 half_a = a->getHalfExtentsWithMargin(), half_b = b->getHalfExtentsWithMargin();
  const btVector3 along_a = from_a.absolute() - half_a - extent * half_b;
  const btVector3 along_b = from_b.absolute() - half_b - half_a * extent;
  return std::max(along_a[along_a.maxAxis()], along_b[along_b.maxAxis()]) > distance;
}

Closest closest(const btBoxShape* a, const btBoxShape* b, const Input& input) {
  btVoronoiSimplexSolver simplex;
  btGjkPairDetector gjk(a, b, &simplex, nullptr);
  Closest out;
  gjk.getClosestPoints(input, out, nullptr);
  return out;
}

}  // namespace

BoxBoxContacts::BoxBoxContacts(const btCollisionAlgorithmConstructionInfo& info,
                               const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b)
    : ContactAlgorithm(info, a, b),
      manifold_(m_dispatcher->getNewManifold(a->getCollisionObject(), b->getCollisionObject())) {}

BoxBoxContacts::~BoxBoxContacts() { m_dispatcher->releaseManifold(manifold_); }

void BoxBoxContacts::processCollision(const btCollisionObjectWrapper* a,
                                      const btCollisionObjectWrapper* b,
                                      const btDispatcherInfo& info, btManifoldResult* result) {
  const btScalar foresight = manifold_->getContactBreakingThreshold();
  Input input;
  input.m_transformA = a->getWorldTransform();
  input.m_transformB = b->getWorldTransform();
  input.m_maximumDistanceSquared = foresight * foresight;
  result->setPersistentManifold(manifold_);
  Counting overlap(*result);
  btBoxBoxDetector(boxOf(a), boxOf(b)).getClosestPoints(input, overlap, info.m_debugDraw);
  if (overlap.count == 0) foresee(boxOf(a), boxOf(b), input, result);
  result->refreshContactPoints();
}

void BoxBoxContacts::foresee(const btBoxShape* a, const btBoxShape* b, const Input& input,
                             btManifoldResult* result) {
  forgetForeseen(*manifold_);
  const btScalar foresight = manifold_->getContactBreakingThreshold();
  if (areFarther(foresight + kGjkExact, a, b, input)) return;
  const Closest apart = closest(a, b, input);
  if (!apart.is_found) return;
  result->addContactPoint(apart.normal, apart.point, apart.distance);
  btPolyhedralContactClipping::clipHullAgainstHull(
      apart.normal, polyhedronOf(a), polyhedronOf(b), input.m_transformA, input.m_transformB,
      apart.distance - foresight, foresight, scratch_[0], scratch_[1], *result);
}

void BoxBoxContacts::getAllContactManifolds(btManifoldArray& manifolds) {
  manifolds.push_back(manifold_);
}

btCollisionAlgorithm* BoxBoxContacts::Creator::CreateCollisionAlgorithm(
    btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* a,
    const btCollisionObjectWrapper* b) {
  void* memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(BoxBoxContacts));
  return new (memory) BoxBoxContacts(info, a, b);
}

}  // namespace kiva
