// SPDX-License-Identifier: Apache-2.0
//
// Bullet's contacts as models see them: impacts, pushes and contact points.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <utility>

#include "core/physics/bodies/touching_parts.h"
#include "core/physics/physics.h"

namespace kiva {
namespace {

// Cosine of the largest angle between a contact's normal and the vertical at which one body lies on
// the other.
constexpr double kLyingOn = 0.5;

bool isFloor(const btCollisionObject& body) {
  return body.getBroadphaseHandle()->m_collisionFilterGroup == kFloorGroup;
}

/// Returns the impulse on the first body, with friction, in the last step [Ns].
btVector3 impulseOf(const btManifoldPoint& point) {
  return point.m_normalWorldOnB * point.m_appliedImpulse +
         point.m_lateralFrictionDir1 * point.m_appliedImpulseLateral1 +
         point.m_lateralFrictionDir2 * point.m_appliedImpulseLateral2;
}

bool isTouching(const btManifoldPoint& point) {
  return point.getDistance() <= 0 || point.getAppliedImpulse() > 0;
}

}  // namespace

void Physics::noteMotions(double dt) {
  dt_ = dt;
  auto& bodies = world_.getNonStaticRigidBodies();
  motions_.resize(bodies.size());
  for (int i = 0; i < bodies.size(); ++i) {
    btRigidBody& body = *bodies[i];
    body.setUserIndex2(i);
    const Velocity driven{body.getLinearVelocity(), body.getAngularVelocity()};
    // Bullet keeps the velocity at a step's end separately from the one that may be set.
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
                         Velocity BodyMotion::*when) const {
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

/// Returns the share of the contact's impulse that ended an approach from before the step,
/// excluding what motors and forces added in it. A contact permits the speed that closes the gap.
double Physics::impactShare(const btPersistentManifold& pair, const btManifoldPoint& point) const {
  const double closing = std::max(0.0, point.getDistance()) / dt_;
  const double was = approach(pair, point, &BodyMotion::before) - closing;
  const double is = approach(pair, point, &BodyMotion::pushed) - closing;
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
  std::unordered_map<std::uint64_t, std::size_t> place;  // index of a pair; for look-up only
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
    const double speed = approach(manifold, point, &BodyMotion::driven);
    pair->nearing = std::max(pair->nearing, speed);
    if (impulse <= pair->most) return;
    pair->most = impulse;
    pair->point = fromBullet(point.getPositionWorldOnB());
    pair->normal = fromBullet(point.m_normalWorldOnB) * sign;
    pair->speed = speed;
  });
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

}  // namespace kiva
