// SPDX-License-Identifier: Apache-2.0
#include "core/physics/solver/planar_solver.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/physics/collision/parting.h"
#include "core/physics/collision/planar_contacts.h"
#include "core/physics/solver/sliding_friction.h"

namespace kiva {
namespace {

constexpr btScalar kLeaning = 1e-9;  // height of a normal that counts as level
constexpr int kFixed = 0;            // index of all that is static, among the bodies
constexpr btScalar kUnlimited = 1e30;

struct Body {
  btScalar inverse_mass = 0, inverse_inertia = 0;  // [1/kg, 1/(kg m²)]
  btScalar vx = 0, vy = 0, turn = 0;               // [m/s, rad/s]
};

/// The effect of an impulse on a body, and its arm.
struct Lever {
  int body = kFixed;
  btScalar arm = 0;                   // [m]
  btScalar vx = 0, vy = 0, turn = 0;  // change by a unit impulse [1/kg, 1/(kg m)]
};

/// One direction in which an impulse acts between two bodies, with its limits.
struct Row {
  btScalar x = 0, y = 0;  // unit vector of the impulse on a
  Lever a, b;
  btScalar mass = 0;             // effective mass [kg]
  btScalar speed = 0;            // velocity of a relative to b along it, after the impulse [m/s]
  btScalar least = 0, most = 0;  // [Ns]
  btScalar impulse = 0;          // [Ns]
};

/// A contact point: its row of pressure, and that of friction.
struct Touch {
  btManifoldPoint* point;
  Row pressing, rubbing;
};

class Solver {
 public:
  void read(const ContactIsland& island, const btContactSolverInfo& info) {
    island_ = island;
    info_ = &info;
    dt_ = info.m_timeStep;
    bodies_.assign(1, Body());
    feet_.clear();
    touches_.clear();
    for (int i = 0; i < island.body_count; ++i) addBody(i);
    for (int i = 0; i < island.joint_count; ++i) addFeet(frictionOf(i));
    for (int i = 0; i < island.manifold_count; ++i) addTouches(*island.manifolds[i]);
  }

  void solve() {
    for (const Touch& touch : touches_) apply(touch.pressing, touch.pressing.impulse);
    iterate([this] {
      btScalar change = 0;
      for (Row& row : feet_) change = std::max(change, settle(row));
      for (Touch& touch : touches_) change = std::max(change, settle(touch.pressing));
      for (Touch& touch : touches_) change = std::max(change, rub(touch));
      return change;
    });
  }

  /// Moves overlapping bodies apart, and none into another one.
  void part() {
    std::vector<Row> rows;
    bool any = false;
    for (const Touch& touch : touches_) {
      Row row = touch.pressing;
      const btScalar distance = touch.point->getDistance();
      row.impulse = 0;
      row.speed = distance > 0 ? -distance / dt_ : partingSpeed(distance, erpOf(*touch.point), dt_);
      any = any || row.speed > 0;
      rows.push_back(row);
    }
    if (!any) return;
    const std::vector<Body> moving = bodies_;
    for (Body& body : bodies_) body.vx = body.vy = body.turn = 0;
    iterate([&] {
      btScalar change = 0;
      for (Row& row : rows) change = std::max(change, settle(row));
      return change;
    });
    for (int i = 0; i < island_.body_count; ++i) shift(bodyOf(i));
    bodies_ = moving;
  }

  void write() const {
    for (int i = 0; i < island_.body_count; ++i) {
      btRigidBody& body = bodyOf(i);
      const Body& b = bodies_[body.getCompanionId()];
      body.setLinearVelocity({b.vx, b.vy, body.getLinearVelocity().z()});
      body.setAngularVelocity({0, 0, b.turn});
      body.setCompanionId(-1);
    }
    const Row* row = feet_.data();
    for (int i = 0; i < island_.joint_count; ++i) row = writeFeet(frictionOf(i), row);
    for (const Touch& touch : touches_) writeTouch(touch);
  }

 private:
  /// Calls sweep(), which returns the square of the largest change of speed, until that is small.
  template <typename Sweep>
  void iterate(Sweep sweep) const {
    btScalar change = kUnlimited;
    for (int i = 0; i < info_->m_numIterations && change > info_->m_leastSquaresResidualThreshold;
         ++i) {
      change = sweep();
    }
  }

  /// Moves the body for one step by the planar shift of its entry.
  void shift(btRigidBody& body) const {
    const Body& b = bodies_[body.getCompanionId()];
    btTransform pose;
    btTransformUtil::integrateTransform(body.getWorldTransform(), {b.vx, b.vy, 0}, {0, 0, b.turn},
                                        dt_, pose);
    body.setWorldTransform(pose);
  }

  btRigidBody& bodyOf(int i) const { return *btRigidBody::upcast(island_.bodies[i]); }
  SlidingFriction& frictionOf(int i) const {
    return static_cast<SlidingFriction&>(*island_.joints[i]);
  }

  /// Adds a body with the effect of external forces in the step.
  void addBody(int i) {
    btRigidBody& body = bodyOf(i);
    body.setCompanionId(static_cast<int>(bodies_.size()));
    const btVector3 v = body.getLinearVelocity(), force = body.getTotalForce();
    Body b;
    b.inverse_mass = body.getInvMass();
    b.inverse_inertia = body.getInvInertiaTensorWorld()[2][2];
    b.vx = v.x() + force.x() * b.inverse_mass * dt_;
    b.vy = v.y() + force.y() * b.inverse_mass * dt_;
    b.turn = body.getAngularVelocity().z() + body.getTotalTorque().z() * b.inverse_inertia * dt_;
    bodies_.push_back(b);
  }

  Lever leverOf(int index, const btVector3& arm, btScalar x, btScalar y) const {
    const Body& body = bodies_[index];
    const btScalar turning = arm.x() * y - arm.y() * x;
    return {index, turning, x * body.inverse_mass, y * body.inverse_mass,
            turning * body.inverse_inertia};
  }

  Row makeRow(int a, int b, const btVector3& arm_a, const btVector3& arm_b, btScalar x,
              btScalar y) const {
    Row row;
    row.x = x;
    row.y = y;
    row.a = leverOf(a, arm_a, x, y);
    row.b = leverOf(b, arm_b, x, y);
    row.mass = 1 / (bodies_[a].inverse_mass + row.a.arm * row.a.turn + bodies_[b].inverse_mass +
                    row.b.arm * row.b.turn);
    return row;
  }

  /// Returns the velocity of a relative to b along the row [m/s].
  btScalar speedAlong(const Row& row) const {
    const Body &a = bodies_[row.a.body], &b = bodies_[row.b.body];
    return (a.vx - b.vx) * row.x + (a.vy - b.vy) * row.y + a.turn * row.a.arm - b.turn * row.b.arm;
  }

  void apply(const Row& row, btScalar impulse) {
    const auto push = [&](const Lever& lever, btScalar size) {
      Body& body = bodies_[lever.body];
      body.vx += lever.vx * size;
      body.vy += lever.vy * size;
      body.turn += lever.turn * size;
    };
    push(row.a, impulse);
    push(row.b, -impulse);
  }

  /// Solves a row. Returns the square of its change of speed.
  btScalar settle(Row& row) {
    const btScalar required = row.impulse + (row.speed - speedAlong(row)) * row.mass;
    const btScalar impulse = std::clamp(required, row.least, row.most);
    const btScalar more = impulse - row.impulse;
    if (more == 0) return 0;
    row.impulse = impulse;
    apply(row, more);
    return more * more / (row.mass * row.mass);
  }

  btScalar rub(Touch& touch) {
    touch.rubbing.most = touch.point->m_combinedFriction * touch.pressing.impulse;
    touch.rubbing.least = -touch.rubbing.most;
    return settle(touch.rubbing);
  }

  /// Adds rows along the motion of each foot, and across.
  void addFeet(const SlidingFriction& friction) {
    const btRigidBody& body = friction.getRigidBodyA();
    for (const SlidingFoot& foot : friction.feet()) {
      const btVector3 arm = body.getWorldTransform().getBasis() * foot.at, none(0, 0, 0);
      const btVector3 along = friction.wayOf(arm);
      for (const btVector3& way : {along, btVector3(-along.y(), along.x(), 0)}) {
        Row row = makeRow(body.getCompanionId(), kFixed, arm, none, way.x(), way.y());
        row.most = foot.grip_limit * dt_;
        row.least = -row.most;
        feet_.push_back(row);
      }
    }
  }

  static int indexOf(const btCollisionObject& object) {
    return object.isStaticObject() ? kFixed : object.getCompanionId();
  }

  void addTouches(btPersistentManifold& manifold) {
    const btCollisionObject &a = *manifold.getBody0(), &b = *manifold.getBody1();
    for (int p = 0; p < manifold.getNumContacts(); ++p) {
      btManifoldPoint& point = manifold.getContactPoint(p);
      if (point.getDistance() > manifold.getContactProcessingThreshold()) {
        point.m_appliedImpulse = point.m_appliedImpulseLateral1 = 0;  // not yet
        continue;
      }
      const btVector3 arm_a = point.getPositionWorldOnA() - a.getWorldTransform().getOrigin();
      const btVector3 arm_b = point.getPositionWorldOnB() - b.getWorldTransform().getOrigin();
      const btVector3& n = point.m_normalWorldOnB;
      Touch touch{&point, makeRow(indexOf(a), indexOf(b), arm_a, arm_b, n.x(), n.y()),
                  makeRow(indexOf(a), indexOf(b), arm_a, arm_b, -n.y(), n.x())};
      touch.pressing.most = kUnlimited;
      touch.pressing.speed = speedAfter(point, speedAlong(touch.pressing));
      touch.pressing.impulse = point.m_appliedImpulse * info_->m_warmstartingFactor;
      touches_.push_back(touch);
    }
  }

  /// Returns the least speed at which contact points part that approached at `before` [m/s].
  btScalar speedAfter(const btManifoldPoint& point, btScalar before) const {
    const bool bounces = -before > info_->m_restitutionVelocityThreshold;
    const btScalar back = bounces ? -before * point.m_combinedRestitution : 0;
    return back - std::max(btScalar(0), point.getDistance()) / dt_;
  }

  /// Returns the share of an overlap that a step corrects.
  btScalar erpOf(const btManifoldPoint& point) const {
    const bool has_own = (point.m_contactPointFlags & BT_CONTACT_FLAG_HAS_CONTACT_ERP) != 0;
    return has_own ? point.m_contactERP : info_->m_erp2;
  }

  /// Writes the impulses of a body's feet. Returns the first row after them.
  const Row* writeFeet(SlidingFriction& friction, const Row* row) const {
    const Row* const end = row + 2 * friction.feet().size();
    btVector3 force(0, 0, 0);
    for (; row != end; ++row) force += btVector3(row->x, row->y, 0) * (row->impulse / dt_);
    friction.getJointFeedback()->m_appliedForceBodyA = force;
    return end;
  }

  static void writeTouch(const Touch& touch) {
    btManifoldPoint& point = *touch.point;
    point.m_appliedImpulse = touch.pressing.impulse;
    point.m_appliedImpulseLateral1 = touch.rubbing.impulse;
    point.m_appliedImpulseLateral2 = 0;
    point.m_lateralFrictionDir1 = {touch.rubbing.x, touch.rubbing.y, 0};
    point.m_lateralFrictionDir2 = {0, 0, 1};
  }

  ContactIsland island_;
  const btContactSolverInfo* info_ = nullptr;
  btScalar dt_ = 0;  // [s]
  std::vector<Body> bodies_;
  std::vector<Row> feet_;
  std::vector<Touch> touches_;
};

bool isLevel(const btPersistentManifold& manifold) {
  for (int i = 0; i < manifold.getNumContacts(); ++i) {
    if (std::abs(manifold.getContactPoint(i).m_normalWorldOnB.z()) > kLeaning) return false;
  }
  return !manifold.getBody0()->isKinematicObject() && !manifold.getBody1()->isKinematicObject();
}

}  // namespace

bool isPlanar(const ContactIsland& island) {
  const auto is_planar = [](const btCollisionObject* object) {
    const btRigidBody* body = btRigidBody::upcast(object);
    return body && isPlanar(*body);
  };
  const auto is_friction = [](const btTypedConstraint* joint) {
    return dynamic_cast<const SlidingFriction*>(joint) != nullptr;
  };
  const auto is_level = [](const btPersistentManifold* manifold) { return isLevel(*manifold); };
  return std::all_of(island.bodies, island.bodies + island.body_count, is_planar) &&
         std::all_of(island.joints, island.joints + island.joint_count, is_friction) &&
         std::all_of(island.manifolds, island.manifolds + island.manifold_count, is_level);
}

void solvePlanar(const ContactIsland& island, const btContactSolverInfo& info) {
  static thread_local Solver solver;  // to reuse its memory
  solver.read(island, info);
  solver.solve();
  solver.part();
  solver.write();
}

}  // namespace kiva
