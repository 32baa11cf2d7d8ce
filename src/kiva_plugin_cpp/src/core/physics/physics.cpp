// SPDX-License-Identifier: Apache-2.0
#include "core/physics/physics.h"

#include <limits>

#include "core/geometry/ray.h"
#include "core/physics/bodies/touching_parts.h"
#include "core/physics/collision/planar_contacts.h"

namespace kiva {
namespace {

// Square of the change of velocity at which the solver ends.
constexpr double kSolved = 1e-12;  // [m2/s2]

// Cosine of the largest tilt of a level unbounded plane.
constexpr double kLevel = 1 - 1e-12;

bool isUnevenFloor(const LinkBody& link) {
  const btCollisionShape& shape = *link.body->getCollisionShape();
  if (link.group != kFloorGroup || (shape.isCompound() && link.shape.parts.empty())) return false;
  if (shape.getShapeType() != STATIC_PLANE_PROXYTYPE) return true;
  const btVector3 normal = static_cast<const btStaticPlaneShape&>(shape).getPlaneNormal();
  return (link.body->getWorldTransform().getBasis() * normal).z() < kLevel;
}

/// Returns whether a part of the model is static.
bool isFixture(const ModelBodies& bodies) {
  return !bodies.surfaces.empty() ||
         std::any_of(bodies.links.begin(), bodies.links.end(),
                     [](const LinkBody& link) { return link.body->isStaticObject(); });
}

/// Reserves room for a few contacts; more are allocated on demand. Bullet's own 4,096 take longer
/// than all the rest of creating or restoring a small world.
btDefaultCollisionConstructionInfo smallPools() {
  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxPersistentManifoldPoolSize = 64;
  info.m_defaultMaxCollisionAlgorithmPoolSize = 64;
  return info;
}

}  // namespace

Physics::Physics(const Vector3& gravity)
    : configuration_(smallPools()),
      round_contacts_(false, configuration_.getCollisionAlgorithmCreateFunc(
                                 CYLINDER_SHAPE_PROXYTYPE, CYLINDER_SHAPE_PROXYTYPE)),
      swapped_round_contacts_(true, round_contacts_.at_edges),
      dispatcher_(&configuration_),
      world_(&dispatcher_, &broadphase_, &solver_, &configuration_) {
  gContactAddedCallback = combineMaterials;
  broadphase_.getOverlappingPairCache()->setOverlapFilterCallback(&own_parts_filter_);
  world_.setGravity(toBullet(gravity));
  world_.setForceUpdateAllAabbs(false);
  // Contacts are foreseen at a fixed distance. A relative one would be less than a thin part's
  // motion in a step, and bodies would sink in before they touch.
  dispatcher_.setDispatcherFlags(
      dispatcher_.getDispatcherFlags() &
      ~btCollisionDispatcher::CD_USE_RELATIVE_CONTACT_BREAKING_THRESHOLD);
  dispatcher_.registerCollisionCreateFunc(BOX_SHAPE_PROXYTYPE, BOX_SHAPE_PROXYTYPE, &box_contacts_);
  static PlanarContacts::Creator planar_contacts;  // stateless
  dispatcher_.registerCollisionCreateFunc(COMPOUND_SHAPE_PROXYTYPE, COMPOUND_SHAPE_PROXYTYPE,
                                          &planar_contacts);
  for (int round : {CYLINDER_SHAPE_PROXYTYPE, CAPSULE_SHAPE_PROXYTYPE}) {
    for (int flat : {STATIC_PLANE_PROXYTYPE, BOX_SHAPE_PROXYTYPE}) {
      dispatcher_.registerCollisionCreateFunc(round, flat, &round_contacts_);
      dispatcher_.registerCollisionCreateFunc(flat, round, &swapped_round_contacts_);
    }
  }
  // Adds all corners of a body that lands on a plane at once: one a step would tip it over.
  configuration_.setPlaneConvexMultipointIterations(4, 4);
  btContactSolverInfo& solver = world_.getSolverInfo();
  solver.m_splitImpulse = true;
  solver.m_splitImpulsePenetrationThreshold = 0;  // overlaps of any size do not change velocities
  solver.m_numIterations = 20;
  solver.m_leastSquaresResidualThreshold = kSolved;
  solver.m_minimumSolverBatchSize = 1;  // each island is iterated until that, not all together
}

Physics::~Physics() = default;

ModelBodies Physics::build(const ModelDescription& description, const Pose& pose, int model,
                           int group, int mask) const {
  return buildBodies(description, pose, model, group, mask);
}

void Physics::insert(ModelBodies& bodies) {
  fixture_changes_ += isFixture(bodies);
  for (auto* list : {&bodies.links, &bodies.surfaces}) {
    for (LinkBody& link : *list) {
      world_.addRigidBody(link.body.get(), link.group, link.mask);
      uneven_floors_ += isUnevenFloor(link);
    }
  }
  for (auto& joint : bodies.joints) world_.addConstraint(joint.get(), true);
}

void Physics::remove(ModelBodies& bodies) {
  fixture_changes_ += isFixture(bodies);
  for (auto& joint : bodies.joints) world_.removeConstraint(joint.get());
  for (auto* list : {&bodies.links, &bodies.surfaces}) {
    for (LinkBody& link : *list) {
      world_.removeRigidBody(link.body.get());
      uneven_floors_ -= isUnevenFloor(link);
    }
  }
}

void Physics::shift(ModelBodies& bodies, const ModelDescription& description, const Pose& pose) {
  ++fixture_changes_;
  for (auto* list : {&bodies.links, &bodies.surfaces}) {
    for (LinkBody& link : *list) {
      link.place(toBullet(pose * description.links[link.link].pose_in_model));
      world_.updateSingleAabb(link.body.get());
    }
  }
}

bool Physics::anyAwake() const {
  const auto& bodies = world_.getNonStaticRigidBodies();
  for (int i = 0; i < bodies.size(); ++i) {
    if (bodies[i]->isActive()) return true;
  }
  return false;
}

void Physics::step(double dt) {
  if (!anyAwake()) return motions_.clear();
  noteMotions(dt);
  world_.stepSimulation(dt, 0);
}

void Physics::setGravity(const Vector3& gravity) {
  world_.setGravity(toBullet(gravity));  // applies to bodies that are awake
  auto& bodies = world_.getNonStaticRigidBodies();
  for (int i = 0; i < bodies.size(); ++i) {
    if ((bodies[i]->getFlags() & BT_DISABLE_WORLD_GRAVITY) == 0) {
      bodies[i]->setGravity(toBullet(gravity));
    }
  }
}

std::vector<btPersistentManifold*> Physics::makeManifolds() {
  world_.updateAabbs();
  world_.computeOverlappingPairs();
  return dispatcher_.makeManifolds(world_.getPairCache(), world_.getDispatchInfo());
}

double Physics::cast(const Vector3& from, const Vector3& direction, double range) const {
  const btVector3 start = toBullet(from), end = toBullet(from + direction * range);
  btCollisionWorld::ClosestRayResultCallback hit(start, end);
  hit.m_collisionFilterGroup = ~0;  // robots do not touch the floor's group, a ray's default
  world_.rayTest(start, end, hit);
  return hit.hasHit() ? hit.m_closestHitFraction * range : std::numeric_limits<double>::infinity();
}

double castBody(const btCollisionObject& body, const Vector3& from, const Vector3& direction,
                double range) {
  const btTransform start(btQuaternion::getIdentity(), toBullet(from));
  const btTransform end(btQuaternion::getIdentity(), toBullet(from + direction * range));
  btCollisionWorld::ClosestRayResultCallback hit(start.getOrigin(), end.getOrigin());
  btCollisionWorld::rayTestSingle(start, end, const_cast<btCollisionObject*>(&body),
                                  body.getCollisionShape(), body.getWorldTransform(), hit);
  return hit.hasHit() ? hit.m_closestHitFraction * range : std::numeric_limits<double>::infinity();
}

}  // namespace kiva
