// SPDX-License-Identifier: Apache-2.0
#include "core/physics/planar_solver.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/physics/planar_contacts.h"
#include "core/physics/sliding_friction.h"

namespace kiva {
namespace {

constexpr btScalar kLevel = 1e-9;  // of a normal's height
constexpr int kFixed = -1;         // instead of a body: what stands still
constexpr btScalar kUnlimited = 1e30;

struct Body {
  btScalar inverse_mass, inverse_inertia;  // [1/kg, 1/(kg m²)]
  btScalar vx, vy, turn;                   // [m/s, rad/s]
};

/// One direction in which an impulse acts between two bodies, and what it may be.
struct Row {
  int a = kFixed, b = kFixed;
  btScalar x = 0, y = 0;              // unit vector, of the impulse on a
  btScalar lever_a = 0, lever_b = 0;  // [m]
  btScalar mass = 0;                  // that it moves [kg]
  btScalar speed = 0;                 // of a seen from b, after it [m/s]
  btScalar least = 0, most = 0;       // [Ns]
  btScalar impulse = 0;               // [Ns]
};

/// A point of contact: what presses, and what rubs.
struct Touch {
  btManifoldPoint* point;
  Row pressing, rubbing;
};

/// Along the way that a foot goes, and across.
struct FootRows {
  Row rows[2];
};

class Island {
 public:
  Island(const ContactIsland& island, const btContactSolverInfo& info)
      : island_(island), info_(info), dt_(info.m_timeStep) {
    for (int i = 0; i < island.body_count; ++i) addBody(i);
    for (int i = 0; i < island.joint_count; ++i) addFeet(frictionOf(i));
    for (int i = 0; i < island.manifold_count; ++i) addTouches(*island.manifolds[i]);
  }

  void solve() {
    for (Touch& touch : touches_) apply(touch.pressing, touch.pressing.impulse);
    btScalar change = kUnlimited;
    for (int i = 0; i < info_.m_numIterations && change > info_.m_leastSquaresResidualThreshold;
         ++i) {
      change = 0;
      for (FootRows& foot : feet_) {
        for (Row& row : foot.rows) change = std::max(change, settle(row));
      }
      for (Touch& touch : touches_) change = std::max(change, settle(touch.pressing));
      for (Touch& touch : touches_) {
        const btScalar limit = touch.point->m_combinedFriction * touch.pressing.impulse;
        touch.rubbing.least = -limit;
        touch.rubbing.most = limit;
        change = std::max(change, settle(touch.rubbing));
      }
    }
  }

  void write() {
    for (int i = 0; i < island_.body_count; ++i) {
      btRigidBody& body = bodyOf(i);
      const Body& b = bodies_[i];
      body.setLinearVelocity({b.vx, b.vy, body.getLinearVelocity().z()});
      body.setAngularVelocity({0, 0, b.turn});
      body.setCompanionId(-1);
    }
    std::size_t foot = 0;
    for (int i = 0; i < island_.joint_count; ++i) writeFeet(frictionOf(i), &foot);
    for (const Touch& touch : touches_) writeTouch(touch);
  }

 private:
  btRigidBody& bodyOf(int i) const { return *btRigidBody::upcast(island_.bodies[i]); }
  SlidingFriction& frictionOf(int i) const {
    return static_cast<SlidingFriction&>(*island_.joints[i]);
  }

  /// With what forces from outside add in the step.
  void addBody(int i) {
    btRigidBody& body = bodyOf(i);
    body.setCompanionId(i);
    const btVector3 v = body.getLinearVelocity(), force = body.getTotalForce();
    const btScalar inverse_mass = body.getInvMass();
    const btScalar inverse_inertia = body.getInvInertiaTensorWorld()[2][2];
    bodies_.push_back(
        {inverse_mass, inverse_inertia, v.x() + force.x() * inverse_mass * dt_,
         v.y() + force.y() * inverse_mass * dt_,
         body.getAngularVelocity().z() + body.getTotalTorque().z() * inverse_inertia * dt_});
  }

  Row makeRow(int a, int b, const btVector3& arm_a, const btVector3& arm_b, btScalar x,
              btScalar y) const {
    Row row;
    row.a = a;
    row.b = b;
    row.x = x;
    row.y = y;
    row.lever_a = arm_a.x() * y - arm_a.y() * x;
    row.lever_b = arm_b.x() * y - arm_b.y() * x;
    btScalar yielding = 0;
    const auto add = [&](int body, btScalar lever) {
      if (body == kFixed) return;
      yielding += bodies_[body].inverse_mass + lever * lever * bodies_[body].inverse_inertia;
    };
    add(a, row.lever_a);
    add(b, row.lever_b);
    row.mass = 1 / yielding;
    return row;
  }

  /// Before the next impulse [m/s].
  btScalar speedAlong(const Row& row) const {
    btScalar speed = 0;
    if (row.a != kFixed) {
      const Body& a = bodies_[row.a];
      speed += a.vx * row.x + a.vy * row.y + a.turn * row.lever_a;
    }
    if (row.b != kFixed) {
      const Body& b = bodies_[row.b];
      speed -= b.vx * row.x + b.vy * row.y + b.turn * row.lever_b;
    }
    return speed;
  }

  void apply(const Row& row, btScalar impulse) {
    if (row.a != kFixed) {
      Body& a = bodies_[row.a];
      a.vx += row.x * impulse * a.inverse_mass;
      a.vy += row.y * impulse * a.inverse_mass;
      a.turn += row.lever_a * impulse * a.inverse_inertia;
    }
    if (row.b != kFixed) {
      Body& b = bodies_[row.b];
      b.vx -= row.x * impulse * b.inverse_mass;
      b.vy -= row.y * impulse * b.inverse_mass;
      b.turn -= row.lever_b * impulse * b.inverse_inertia;
    }
  }

  /// Returns the square of the speed that it changed.
  btScalar settle(Row& row) {
    const btScalar wanted = row.impulse + (row.speed - speedAlong(row)) * row.mass;
    const btScalar impulse = std::clamp(wanted, row.least, row.most);
    const btScalar more = impulse - row.impulse;
    if (more == 0) return 0;
    row.impulse = impulse;
    apply(row, more);
    return more * more / (row.mass * row.mass);
  }

  void addFeet(const SlidingFriction& friction) {
    const btRigidBody& body = friction.getRigidBodyA();
    for (const Foot& foot : friction.feet()) {
      const btVector3 arm = body.getWorldTransform().getBasis() * foot.at;
      const btVector3 along = friction.wayOf(arm);
      FootRows feet;
      const btVector3 none(0, 0, 0);
      feet.rows[0] = makeRow(body.getCompanionId(), kFixed, arm, none, along.x(), along.y());
      feet.rows[1] = makeRow(body.getCompanionId(), kFixed, arm, none, -along.y(), along.x());
      for (Row& row : feet.rows) {
        row.most = foot.grip_limit * dt_;
        row.least = -row.most;
      }
      feet_.push_back(feet);
    }
  }

  int indexOf(const btCollisionObject& object) const {
    return object.isStaticObject() ? kFixed : object.getCompanionId();
  }

  void addTouches(btPersistentManifold& manifold) {
    const btCollisionObject &a = *manifold.getBody0(), &b = *manifold.getBody1();
    for (int p = 0; p < manifold.getNumContacts(); ++p) {
      btManifoldPoint& point = manifold.getContactPoint(p);
      const btVector3 arm_a = point.getPositionWorldOnA() - a.getWorldTransform().getOrigin();
      const btVector3 arm_b = point.getPositionWorldOnB() - b.getWorldTransform().getOrigin();
      const btVector3& n = point.m_normalWorldOnB;
      Touch touch{&point, makeRow(indexOf(a), indexOf(b), arm_a, arm_b, n.x(), n.y()),
                  makeRow(indexOf(a), indexOf(b), arm_a, arm_b, -n.y(), n.x())};
      touch.pressing.most = kUnlimited;
      touch.pressing.speed = speedAfter(point, speedAlong(touch.pressing));
      touch.pressing.impulse = point.m_appliedImpulse * info_.m_warmstartingFactor;
      touches_.push_back(touch);
    }
  }

  /// At which points of contact may part at least, of those that had `before` [m/s]. What overlaps
  /// is brought apart bit by bit.
  btScalar speedAfter(const btManifoldPoint& point, btScalar before) const {
    const bool bounces = -before > info_.m_restitutionVelocityThreshold;
    const btScalar back = bounces ? -before * point.m_combinedRestitution : 0;
    const bool has_own = (point.m_contactPointFlags & BT_CONTACT_FLAG_HAS_CONTACT_ERP) != 0;
    const btScalar share = has_own ? point.m_contactERP : info_.m_erp2;
    const btScalar distance = point.getDistance();
    return back - (distance > 0 ? distance : distance * share) / dt_;
  }

  void writeFeet(SlidingFriction& friction, std::size_t* next) const {
    btVector3 force(0, 0, 0);
    for (std::size_t i = 0; i < friction.feet().size(); ++i) {
      for (const Row& row : feet_[(*next)++].rows) {
        force += btVector3(row.x, row.y, 0) * (row.impulse / dt_);
      }
    }
    friction.getJointFeedback()->m_appliedForceBodyA = force;
  }

  static void writeTouch(const Touch& touch) {
    btManifoldPoint& point = *touch.point;
    point.m_appliedImpulse = touch.pressing.impulse;
    point.m_appliedImpulseLateral1 = touch.rubbing.impulse;
    point.m_appliedImpulseLateral2 = 0;
    point.m_lateralFrictionDir1 = {touch.rubbing.x, touch.rubbing.y, 0};
    point.m_lateralFrictionDir2 = {0, 0, 1};
  }

  const ContactIsland& island_;
  const btContactSolverInfo& info_;
  const btScalar dt_;
  std::vector<Body> bodies_;
  std::vector<FootRows> feet_;
  std::vector<Touch> touches_;
};

bool isLevel(const btPersistentManifold& manifold) {
  for (int i = 0; i < manifold.getNumContacts(); ++i) {
    if (std::abs(manifold.getContactPoint(i).m_normalWorldOnB.z()) > kLevel) return false;
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
  Island solver(island, info);
  solver.solve();
  solver.write();
}

}  // namespace kiva
