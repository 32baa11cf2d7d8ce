// SPDX-License-Identifier: Apache-2.0
#include "core/physics/physics.h"

#include <BulletCollision/CollisionShapes/btConvexPolyhedron.h>
#include <LinearMath/btConvexHullComputer.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <new>
#include <unordered_map>
#include <utility>

#include "core/geometry/ray.h"
#include "core/physics/planar_contacts.h"
#include "core/physics/triangle_tree.h"

namespace kiva {
namespace {

// GJK works on a core shape and rounds its edges by this margin; contacts stay exact to less than
// half of it.
constexpr double kMargin = 0.0002;  // [m]

// Bullet's own distance at which contacts are foreseen.
constexpr double kForesight = 0.02;  // [m]

// Share of its depth by which a body that could bounce is lifted out in a step; more would throw
// it. What moves faster than Bullet lets bounce is not lifted: it leaves by itself.
constexpr double kGentle = 0.02;
constexpr double kBouncing = 0.2;  // [m/s]

// What is slower for two seconds falls asleep; Bullet's own 0.8 m/s would stop a pendulum.
constexpr double kAsleep = 0.005;  // [m/s, rad/s]

// The solver ends when an iteration changes no velocity by more than the root of this.
constexpr double kSolved = 1e-12;  // [m2/s2]

// Cosine of the angle at which an unbounded plane is not level any more.
constexpr double kLevel = 1 - 1e-12;

// Cosine to the vertical of a contact's normal, of which one body lies on the other.
constexpr double kLyingOn = 0.5;

/// A shape whose bounding box is padded by that distance: within compounds Bullet compares bare
/// boxes, and a fast body would sink in before its parts are looked at.
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

/// A box whose faces are worked out once for all of its size: a body is rebuilt whenever it
/// comes near another, and has them as soon as they may touch.
class Box : public Foreseeing<btBoxShape> {
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
  auto box = std::make_unique<Box>(toBullet(shape.size * 0.5));
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

/// Returns the convex hull of a mesh that moves.
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

/// The triangles of a mesh that stands still, as they are.
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

/// Returns whether the collision is a static body of its own, since it has no volume for Bullet.
bool isSurface(const Collision& collision, bool is_static) {
  const Shape::Kind kind = collision.shape.kind;
  return kind == Shape::Kind::kPlane || (kind == Shape::Kind::kMesh && is_static);
}

std::unique_ptr<BodyPart> makePart(const Collision& collision, int model, bool is_static = false) {
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

/// What the bodies of one model share.
struct BodyContext {
  bool is_static;
  btTransform model_pose;
  int model;
  int group, mask;
};

LinkBody finishBody(LinkBody body, const Link& link, const BodyContext& context,
                    btCollisionShape* shape) {
  const bool moves = !context.is_static;
  btRigidBody::btRigidBodyConstructionInfo info(
      moves ? link.mass : 0, nullptr, shape,
      moves ? toBullet(link.principal_moments) : btVector3(0, 0, 0));
  body.group = context.group;
  body.mask = context.mask;
  body.body = std::make_unique<btRigidBody>(info);
  body.body->setUserIndex(context.model);
  body.body->setCollisionFlags(body.body->getCollisionFlags() |
                               btCollisionObject::CF_CUSTOM_MATERIAL_CALLBACK);
  body.body->setSleepingThresholds(kAsleep, kAsleep);
  if (!link.gravity) body.body->setFlags(body.body->getFlags() | BT_DISABLE_WORLD_GRAVITY);
  body.place(context.model_pose * toBullet(link.pose_in_model));
  return body;
}

LinkBody makeSurface(const Link& link, int index, const Collision& surface,
                     const BodyContext& context) {
  LinkBody out;
  out.link = index;
  out.mass_frame = toBullet(surface.pose_in_link);
  out.surface = makePart(surface, context.model, context.is_static);
  btCollisionShape* shape = out.surface->shape.get();
  return finishBody(std::move(out), link, context, shape);
}

LinkBody makeBody(const Link& link, int index, const BodyContext& context) {
  LinkBody out;
  out.link = index;
  out.mass_frame =
      context.is_static ? btTransform::getIdentity() : toBullet(link.inertial_pose_in_link);
  const btTransform in_body = out.mass_frame.inverse();
  for (const Collision& collision : link.collisions) {
    if (isSurface(collision, context.is_static)) continue;
    out.shape.add(collision, in_body * toBullet(collision.pose_in_link), context.model);
  }
  btCollisionShape* shape = out.shape.compound.get();
  LinkBody body = finishBody(std::move(out), link, context, shape);
  // A contact that is foreseen slows a body down before it could bounce.
  const bool bounces = std::any_of(link.collisions.begin(), link.collisions.end(),
                                   [](const Collision& c) { return c.restitution > 0; });
  if (bounces) body.body->setContactProcessingThreshold(0);
  return body;
}

/// Joint frame: origin at the anchor, `along` (0 = x, 2 = z) on the axis; in world.
btTransform jointFrame(const Joint& joint, const btTransform& model, int along) {
  const btVector3 axis = toBullet(joint.axis_in_model).normalized();
  btVector3 u, v;
  btPlaneSpace1(axis, u, v);
  const btMatrix3x3 basis =
      along == 0
          ? btMatrix3x3(axis.x(), u.x(), v.x(), axis.y(), u.y(), v.y(), axis.z(), u.z(), v.z())
          : btMatrix3x3(u.x(), v.x(), axis.x(), u.y(), v.y(), axis.y(), u.z(), v.z(), axis.z());
  return model * btTransform(basis, toBullet(joint.anchor_in_model));
}

btRigidBody& fixedBody() { return btTypedConstraint::getFixedBody(); }

struct JointEnds {
  btRigidBody& parent;
  btRigidBody& child;
};

std::unique_ptr<btTypedConstraint> makeHinge(const Joint& joint, const JointEnds& ends,
                                             const btTransform& model) {
  const btTransform frame = jointFrame(joint, model, 2);
  auto hinge = std::make_unique<btHingeConstraint>(
      ends.parent, ends.child, ends.parent.getWorldTransform().inverse() * frame,
      ends.child.getWorldTransform().inverse() * frame);
  // Bullet counts a hinge's angle from parent to child the other way round.
  if (joint.kind == Joint::Kind::kRevolute && joint.upper - joint.lower < 2 * SIMD_PI) {
    hinge->setLimit(-joint.upper, -joint.lower);
  }
  return hinge;
}

std::unique_ptr<btTypedConstraint> makeSlider(const Joint& joint, const JointEnds& ends,
                                              const btTransform& model) {
  const btTransform frame = jointFrame(joint, model, 0);
  auto slider = std::make_unique<btSliderConstraint>(
      ends.parent, ends.child, ends.parent.getWorldTransform().inverse() * frame,
      ends.child.getWorldTransform().inverse() * frame, true);
  slider->setLowerLinLimit(joint.lower);
  slider->setUpperLinLimit(joint.upper);
  slider->setLowerAngLimit(0);
  slider->setUpperAngLimit(0);
  return slider;
}

std::unique_ptr<btTypedConstraint> makeBall(const Joint& joint, const JointEnds& ends,
                                            const btTransform& model) {
  const btVector3 anchor = model * toBullet(joint.anchor_in_model);
  return std::make_unique<btPoint2PointConstraint>(
      ends.parent, ends.child, ends.parent.getWorldTransform().inverse() * anchor,
      ends.child.getWorldTransform().inverse() * anchor);
}

std::unique_ptr<btTypedConstraint> makeJoint(const Joint& joint, const JointEnds& ends,
                                             const btTransform& model) {
  if (joint.kind == Joint::Kind::kPrismatic) return makeSlider(joint, ends, model);
  if (joint.kind == Joint::Kind::kBall) return makeBall(joint, ends, model);
  if (joint.kind != Joint::Kind::kFixed) return makeHinge(joint, ends, model);
  const btTransform frame = ends.child.getWorldTransform();
  return std::make_unique<btFixedConstraint>(ends.parent, ends.child,
                                             ends.parent.getWorldTransform().inverse() * frame,
                                             btTransform::getIdentity());
}

btRigidBody& bodyOf(const ModelDescription& description, ModelBodies& bodies,
                    const std::string& link) {
  for (std::size_t i = 0; i < description.links.size(); ++i) {
    if (description.links[i].name == link) return *bodies.links[i].body;
  }
  return fixedBody();  // "world"
}

const BodyPart* partOf(const btCollisionShape* shape) {
  return static_cast<const BodyPart*>(shape->getUserPointer());
}

/// Returns the part that touches; a mesh touches by its triangles, which know no part.
const BodyPart* partOf(const btCollisionObjectWrapper* wrapper) {
  for (; wrapper; wrapper = wrapper->m_parent) {
    if (const BodyPart* part = partOf(wrapper->getCollisionShape())) return part;
  }
  return nullptr;
}

/// Returns the part of a body that a contact is with; null for a plane, which has but one.
const BodyPart* touchedPart(const btCollisionObject* object, int part) {
  const btCollisionShape* shape = object->getCollisionShape();
  if (!shape->isCompound()) return partOf(shape);
  const auto* compound = static_cast<const btCompoundShape*>(shape);
  if (part < 0 || part >= compound->getNumChildShapes()) return nullptr;
  return partOf(compound->getChildShape(part));
}

int modelOfPart(const btCollisionObject* object, int part) {
  const BodyPart* touched = touchedPart(object, part);
  return touched ? touched->model : object->getUserIndex();
}

bool isFloor(const btCollisionObject& body) {
  return body.getBroadphaseHandle()->m_collisionFilterGroup == kFloorGroup;
}

bool isUnevenFloor(const LinkBody& link) {
  const btCollisionShape& shape = *link.body->getCollisionShape();
  if (link.group != kFloorGroup || (shape.isCompound() && link.shape.parts.empty())) return false;
  if (shape.getShapeType() != STATIC_PLANE_PROXYTYPE) return true;
  const btVector3 normal = static_cast<const btStaticPlaneShape&>(shape).getPlaneNormal();
  return (link.body->getWorldTransform().getBasis() * normal).z() < kLevel;
}

/// On the first body, with friction, in the last step [Ns].
btVector3 impulseOf(const btManifoldPoint& point) {
  return point.m_normalWorldOnB * point.m_appliedImpulse +
         point.m_lateralFrictionDir1 * point.m_appliedImpulseLateral1 +
         point.m_lateralFrictionDir2 * point.m_appliedImpulseLateral2;
}

bool isTouching(const btManifoldPoint& point) {
  return point.getDistance() <= 0 || point.getAppliedImpulse() > 0;
}

/// Returns the velocity of the contact's points against each other, along its normal [m/s].
double normalSpeed(const btManifoldPoint& point, const btCollisionObject* a,
                   const btCollisionObject* b) {
  btScalar speed = 0;
  for (const btCollisionObject* object : {a, b}) {
    const btRigidBody* body = btRigidBody::upcast(object);
    const btVector3 arm = point.getPositionWorldOnB() - object->getWorldTransform().getOrigin();
    const btScalar along = body->getVelocityInLocalPoint(arm).dot(point.m_normalWorldOnB);
    speed += object == a ? along : -along;
  }
  return std::abs(speed);
}

/// Gives a contact the friction and restitution of the two parts that touch: as in Gazebo, the
/// smaller of both. It is called in every step that finds the contact.
bool combineMaterials(btManifoldPoint& point, const btCollisionObjectWrapper* a, int, int,
                      const btCollisionObjectWrapper* b, int, int) {
  const BodyPart* part_a = partOf(a);
  const BodyPart* part_b = partOf(b);
  if (part_a && part_b) {
    point.m_combinedFriction = std::min(part_a->friction, part_b->friction);
    point.m_combinedRestitution = std::min(part_a->restitution, part_b->restitution);
    if (part_a->restitution > 0 || part_b->restitution > 0) {  // not foreseen: they sink in a bit
      const bool bounces =
          point.m_combinedRestitution > 0 &&
          normalSpeed(point, a->getCollisionObject(), b->getCollisionObject()) > kBouncing;
      point.m_contactPointFlags |= BT_CONTACT_FLAG_HAS_CONTACT_ERP;
      point.m_contactERP = bounces ? 0 : kGentle;
    }
  }
  return true;
}

/// Contacts for which there is room from the start; more find theirs in the heap. To lay out
/// Bullet's own 4,096 takes longer than all else that makes a small world, or restores one.
btDefaultCollisionConstructionInfo smallPools() {
  btDefaultCollisionConstructionInfo info;
  info.m_defaultMaxPersistentManifoldPoolSize = 64;
  info.m_defaultMaxCollisionAlgorithmPoolSize = 64;
  return info;
}

}  // namespace

btVector3 toBullet(const Vector3& v) { return {v.X(), v.Y(), v.Z()}; }
Vector3 fromBullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

btTransform toBullet(const Pose& pose) {
  const Quaternion& q = pose.Rot();
  return btTransform(btQuaternion(q.X(), q.Y(), q.Z(), q.W()), toBullet(pose.Pos()));
}

Pose fromBullet(const btTransform& transform) {
  const btQuaternion q = transform.getRotation();
  return Pose(fromBullet(transform.getOrigin()), Quaternion(q.w(), q.x(), q.y(), q.z()));
}

void BodyShape::add(const Collision& collision, const btTransform& pose, int model) {
  parts.push_back(makePart(collision, model));
  compound->addChildShape(pose, parts.back()->shape.get());
}

void LinkBody::place(const btTransform& link_pose) {
  const btTransform pose = link_pose * mass_frame;
  body->setWorldTransform(pose);
  body->setInterpolationWorldTransform(pose);
  body->updateInertiaTensor();
  body->setUserIndex3(kPlaced);
}

btVector3 LinkBody::velocityAtOrigin() const {
  const btVector3 arm = linkPose().getOrigin() - body->getWorldTransform().getOrigin();
  return body->getVelocityInLocalPoint(arm);
}

Physics::Physics(const Vector3& gravity)
    : configuration_(smallPools()),
      round_contacts_(false, configuration_.getCollisionAlgorithmCreateFunc(
                                 CYLINDER_SHAPE_PROXYTYPE, CYLINDER_SHAPE_PROXYTYPE)),
      swapped_round_contacts_(true, round_contacts_.at_edges),
      dispatcher_(&configuration_),
      world_(&dispatcher_, &broadphase_, &solver_, &configuration_) {
  gContactAddedCallback = combineMaterials;
  world_.setGravity(toBullet(gravity));
  world_.setForceUpdateAllAabbs(false);
  // A fixed distance at which contacts are foreseen; the relative one would be less than a thin
  // segment's way in a step, and bodies would sink in before they touch.
  dispatcher_.setDispatcherFlags(
      dispatcher_.getDispatcherFlags() &
      ~btCollisionDispatcher::CD_USE_RELATIVE_CONTACT_BREAKING_THRESHOLD);
  dispatcher_.registerCollisionCreateFunc(BOX_SHAPE_PROXYTYPE, BOX_SHAPE_PROXYTYPE, &box_contacts_);
  static PlanarContacts::Creator planar_contacts;  // keeps nothing
  dispatcher_.registerCollisionCreateFunc(COMPOUND_SHAPE_PROXYTYPE, COMPOUND_SHAPE_PROXYTYPE,
                                          &planar_contacts);
  for (int round : {CYLINDER_SHAPE_PROXYTYPE, CAPSULE_SHAPE_PROXYTYPE}) {
    for (int flat : {STATIC_PLANE_PROXYTYPE, BOX_SHAPE_PROXYTYPE}) {
      dispatcher_.registerCollisionCreateFunc(round, flat, &round_contacts_);
      dispatcher_.registerCollisionCreateFunc(flat, round, &swapped_round_contacts_);
    }
  }
  // All corners of what lands on a plane at once: one a step would tip it over.
  configuration_.setPlaneConvexMultipointIterations(4, 4);
  btContactSolverInfo& solver = world_.getSolverInfo();
  solver.m_numIterations = 20;
  solver.m_leastSquaresResidualThreshold = kSolved;
  solver.m_minimumSolverBatchSize = 1;  // each island until that, not all until the last one
}

Physics::~Physics() = default;

ModelBodies Physics::build(const ModelDescription& description, const Pose& pose, int model,
                           int group, int mask) const {
  ModelBodies out;
  const BodyContext context{description.is_static, toBullet(pose), model, group, mask};
  for (std::size_t i = 0; i < description.links.size(); ++i) {
    const Link& link = description.links[i];
    out.links.push_back(makeBody(link, static_cast<int>(i), context));
    for (const Collision& collision : link.collisions) {
      if (!isSurface(collision, description.is_static)) continue;
      out.surfaces.push_back(makeSurface(link, static_cast<int>(i), collision, context));
    }
  }
  if (description.is_static) return out;
  const btVector3 none(0, 0, 0);
  out.feedback.assign(description.joints.size(), {none, none, none, none});
  for (const Joint& joint : description.joints) {
    const JointEnds ends{bodyOf(description, out, joint.parent),
                         bodyOf(description, out, joint.child)};
    out.joints.push_back(makeJoint(joint, ends, toBullet(pose)));
    out.joints.back()->setJointFeedback(&out.feedback[out.joints.size() - 1]);
    mark(*out.joints.back(), model, static_cast<int>(out.joints.size()));
  }
  return out;
}

void Physics::insert(ModelBodies& bodies) {
  for (auto* list : {&bodies.links, &bodies.surfaces}) {
    for (LinkBody& link : *list) {
      world_.addRigidBody(link.body.get(), link.group, link.mask);
      uneven_floors_ += isUnevenFloor(link);
    }
  }
  for (auto& joint : bodies.joints) world_.addConstraint(joint.get(), true);
}

void Physics::remove(ModelBodies& bodies) {
  for (auto& joint : bodies.joints) world_.removeConstraint(joint.get());
  for (auto* list : {&bodies.links, &bodies.surfaces}) {
    for (LinkBody& link : *list) {
      world_.removeRigidBody(link.body.get());
      uneven_floors_ -= isUnevenFloor(link);
    }
  }
}

void Physics::shift(ModelBodies& bodies, const ModelDescription& description, const Pose& pose) {
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
  world_.setGravity(toBullet(gravity));  // of bodies that are awake
  auto& bodies = world_.getNonStaticRigidBodies();
  for (int i = 0; i < bodies.size(); ++i) {
    if ((bodies[i]->getFlags() & BT_DISABLE_WORLD_GRAVITY) == 0) {
      bodies[i]->setGravity(toBullet(gravity));
    }
  }
}

void Physics::noteMotions(double dt) {
  dt_ = dt;
  auto& bodies = world_.getNonStaticRigidBodies();
  motions_.resize(bodies.size());
  for (int i = 0; i < bodies.size(); ++i) {
    btRigidBody& body = *bodies[i];
    body.setUserIndex2(i);
    const Velocity driven{body.getLinearVelocity(), body.getAngularVelocity()};
    // Bullet keeps the velocity that a step ended with beside that which may be set.
    const Velocity ended{body.getInterpolationLinearVelocity(),
                         body.getInterpolationAngularVelocity()};
    const btVector3 force =
        body.getGravity() / std::max(SIMD_EPSILON, body.getInvMass()) + body.getTotalForce();
    const Velocity pushed{driven.linear + force * body.getLinearFactor() * body.getInvMass() * dt,
                          driven.angular + body.getInvInertiaTensorWorld() * body.getTotalTorque() *
                                               body.getAngularFactor() * dt};
    motions_[i] = {body.getUserIndex3() == kPlaced ? driven : ended, driven, pushed};
    body.setUserIndex3(-1);
  }
}

double Physics::approach(const btPersistentManifold& pair, const btManifoldPoint& point,
                         Velocity Motion::*when) const {
  const btVector3 at = point.getPositionWorldOnB();
  const auto velocity = [&](const btCollisionObject* body) {
    const int index = body->isStaticObject() ? -1 : body->getUserIndex2();
    if (index < 0 || index >= static_cast<int>(motions_.size())) return btVector3(0, 0, 0);
    const btVector3 arm = at - body->getWorldTransform().getOrigin();
    const Velocity& v = motions_[index].*when;
    return v.linear + v.angular.cross(arm);
  };
  const btVector3 relative = velocity(pair.getBody1()) - velocity(pair.getBody0());
  return std::max(0.0, relative.dot(point.m_normalWorldOnB));
}

/// Returns what share of the contact's impulse ended approach from before the step, and not what
/// motors and forces added in it: the contact let pass what closes the gap.
double Physics::impactShare(const btPersistentManifold& pair, const btManifoldPoint& point) const {
  const double closing = std::max(0.0, point.getDistance()) / dt_;
  const double was = approach(pair, point, &Motion::before) - closing;
  const double is = approach(pair, point, &Motion::pushed) - closing;
  if (was <= 0) return 0;
  return is > was ? was / is : 1;
}

template <typename Visit>
void Physics::forEachTouch(Visit visit) const {
  for (const btPersistentManifold* manifold : manifolds()) {
    for (int p = 0; p < manifold->getNumContacts(); ++p) {
      const btManifoldPoint& point = manifold->getContactPoint(p);
      if (!isTouching(point)) continue;
      const int a = modelOfPart(manifold->getBody0(), point.m_index0);
      const int b = modelOfPart(manifold->getBody1(), point.m_index1);
      if (a != b) visit(*manifold, point, a, b);
    }
  }
}

void Physics::contacts(std::vector<Contact>* out) const {
  out->clear();
  std::unordered_map<std::uint64_t, std::size_t> place;  // of a pair; for looking up only
  forEachTouch([&](const btPersistentManifold& manifold, const btManifoldPoint& point, int a,
                   int b) {
    const double sign = a > b ? -1 : 1;
    if (a > b) std::swap(a, b);
    const std::uint64_t key = static_cast<std::uint64_t>(a) << 32 | static_cast<std::uint32_t>(b);
    const auto [at, is_new] = place.try_emplace(key, out->size());
    if (is_new) {
      out->push_back({});
      out->back().model_a = a;
      out->back().model_b = b;
    }
    Contact* const pair = &(*out)[at->second];
    const double impulse = point.getAppliedImpulse();
    pair->impulse += impulse * impactShare(manifold, point);
    const double speed = approach(manifold, point, &Motion::driven);
    pair->nearing = std::max(pair->nearing, speed);
    if (impulse <= pair->most) return;
    pair->most = impulse;
    pair->point = fromBullet(point.getPositionWorldOnB());
    pair->normal = fromBullet(point.m_normalWorldOnB) * sign;
    pair->speed = speed;
  });
}

std::vector<btPersistentManifold*> Physics::makeManifolds() {
  world_.updateAabbs();
  world_.computeOverlappingPairs();
  return dispatcher_.makeManifolds(world_.getPairCache(), world_.getDispatchInfo());
}

std::vector<Push> Physics::pushes() const {
  std::vector<Push> out(motions_.size());
  for (const btPersistentManifold* manifold : manifolds()) {
    if (isFloor(*manifold->getBody0()) || isFloor(*manifold->getBody1())) continue;
    for (int p = 0; p < manifold->getNumContacts(); ++p) {
      const btManifoldPoint& point = manifold->getContactPoint(p);
      const btVector3 impulse = impulseOf(point);
      for (const bool is_a : {true, false}) {
        const btCollisionObject* body = is_a ? manifold->getBody0() : manifold->getBody1();
        const int index = body->isStaticObject() ? -1 : body->getUserIndex2();
        if (index < 0 || index >= static_cast<int>(out.size())) continue;
        const btVector3 on_it = is_a ? impulse : -impulse;
        const btVector3 arm = point.getPositionWorldOnB() - body->getWorldTransform().getOrigin();
        if (std::abs(point.m_normalWorldOnB.z()) > kLyingOn) out[index].load -= on_it.z();
        out[index].moment += arm.cross(on_it);
      }
    }
  }
  return out;
}

std::vector<TouchPoint> Physics::touchPoints(int model) const {
  std::vector<TouchPoint> out;
  forEachTouch(
      [&](const btPersistentManifold& manifold, const btManifoldPoint& point, int a, int b) {
        if (a != model && b != model) return;
        const btVector3 impulse = impulseOf(point);
        TouchPoint touch{manifold.getBody0(),
                         manifold.getBody1(),
                         touchedPart(manifold.getBody0(), point.m_index0),
                         touchedPart(manifold.getBody1(), point.m_index1),
                         fromBullet(point.getPositionWorldOnB()),
                         fromBullet(point.m_normalWorldOnB),
                         std::max(0.0, -point.getDistance()),
                         fromBullet(impulse)};
        if (b == model) {
          std::swap(touch.body_a, touch.body_b);
          std::swap(touch.part_a, touch.part_b);
          touch.normal = -touch.normal;
          touch.impulse = -touch.impulse;
        }
        out.push_back(touch);
      });
  return out;
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
