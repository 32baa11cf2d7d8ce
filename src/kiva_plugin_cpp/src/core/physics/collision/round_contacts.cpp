// SPDX-License-Identifier: Apache-2.0
#include "core/physics/collision/round_contacts.h"

#include <BulletCollision/CollisionDispatch/btCollisionDispatcher.h>
#include <BulletCollision/CollisionDispatch/btCollisionObjectWrapper.h>
#include <BulletCollision/CollisionDispatch/btManifoldResult.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>

namespace kiva {
namespace {

constexpr btScalar kInfinity = std::numeric_limits<btScalar>::infinity();

/// Share of a line contact's load at each of its ends if it rests evenly. With the rest in the
/// middle, the resistance to spinning is that of an even load: a quarter of friction times load
/// times length.
constexpr btScalar kEndShare = 0.25;

constexpr btScalar kRounding = 1e-9;  // [m]

/// Share of a contact's last impulse with which Bullet's solver starts.
constexpr btScalar kWarmStart = 0.85;

/// A cylinder, or a capsule with its round ends.
struct Round {
  explicit Round(const btCollisionObjectWrapper& wrapper)
      : centre(wrapper.getWorldTransform().getOrigin()),
        axis(wrapper.getWorldTransform().getBasis().getColumn(2)) {
    const btCollisionShape* shape = wrapper.getCollisionShape();
    is_capsule = shape->getShapeType() == CAPSULE_SHAPE_PROXYTYPE;
    if (is_capsule) {
      const auto* capsule = static_cast<const btCapsuleShape*>(shape);
      radius = capsule->getRadius();
      half_length = capsule->getHalfHeight();
    } else {
      const btVector3 half = static_cast<const btCylinderShape*>(shape)->getHalfExtentsWithMargin();
      radius = half.x();
      half_length = half.z();
    }
  }
  btVector3 centre, axis;
  btScalar radius, half_length;
  bool is_capsule;
};

/// A plane, or the face of a box, in world.
struct Flat {
  btVector3 normal, point;  // outward normal, and a point of the surface
  btVector3 side[2];        // unit vectors along a face's edges
  btScalar half[2] = {kInfinity, kInfinity};

  btScalar above(const btVector3& at) const { return normal.dot(at - point); }
  /// Returns whether a point is above or below the surface itself, and not beside it.
  bool isLevelWith(const btVector3& at) const {
    for (int i = 0; i < 2; ++i) {
      if (half[i] < kInfinity && std::abs(side[i].dot(at - point)) > half[i] + kRounding) {
        return false;
      }
    }
    return true;
  }
};

Flat planeOf(const btCollisionObjectWrapper& wrapper) {
  const auto* plane = static_cast<const btStaticPlaneShape*>(wrapper.getCollisionShape());
  const btTransform& pose = wrapper.getWorldTransform();
  Flat flat;
  flat.normal = pose.getBasis() * plane->getPlaneNormal();
  flat.point = pose * (plane->getPlaneNormal() * plane->getPlaneConstant());
  return flat;
}

/// Returns the face towards `at`.
Flat faceOf(const btCollisionObjectWrapper& wrapper, const btVector3& at) {
  const btTransform& pose = wrapper.getWorldTransform();
  const btVector3 half =
      static_cast<const btBoxShape*>(wrapper.getCollisionShape())->getHalfExtentsWithMargin();
  const btVector3 local = pose.invXform(at);
  int out = 0;
  for (int i = 1; i < 3; ++i) {
    if (std::abs(local[i]) - half[i] > std::abs(local[out]) - half[out]) out = i;
  }
  const btScalar sign = local[out] < 0 ? -1 : 1;
  Flat flat;
  flat.normal = pose.getBasis().getColumn(out) * sign;
  flat.point = pose.getOrigin() + flat.normal * half[out];
  for (int i = 0; i < 2; ++i) {
    const int along = (out + 1 + i) % 3;
    flat.side[i] = pose.getBasis().getColumn(along);
    flat.half[i] = half[along];
  }
  return flat;
}

/// Points of the round body that may touch.
struct TouchCandidates {
  int count = 0;
  btVector3 at[4];
  bool is_line = false;  // the middle, then both ends
  bool is_edge = false;  // no point: an edge of the box touches
  void add(const btVector3& point) { at[count++] = point; }
};

/// Clips the line from a to b to the part above the face. Returns false if nothing is left.
bool clip(const Flat& flat, btVector3* a, btVector3* b) {
  btScalar from = 0, to = 1;
  const btVector3 way = *b - *a;
  for (int i = 0; i < 2; ++i) {
    if (flat.half[i] == kInfinity) continue;
    const btScalar start = flat.side[i].dot(*a - flat.point), speed = flat.side[i].dot(way);
    if (std::abs(speed) < SIMD_EPSILON) {
      if (std::abs(start) > flat.half[i]) return false;
      continue;
    }
    const btScalar t0 = (-flat.half[i] - start) / speed, t1 = (flat.half[i] - start) / speed;
    from = std::max(from, std::min(t0, t1));
    to = std::min(to, std::max(t0, t1));
  }
  if (from >= to) return false;
  *b = *a + way * to;
  *a += way * from;
  return true;
}

/// Determines contacts of the lower cap: corners of a face beneath it, and the part of its rim
/// above the face.
TouchCandidates findOnCap(const Round& round, const Flat& flat, const btVector3& cap,
                          const btVector3& reach) {
  TouchCandidates out;
  const btScalar lean = round.axis.dot(flat.normal);
  for (int corner = 0; corner < 4 && flat.half[0] < kInfinity; ++corner) {
    btVector3 at = flat.point + flat.side[0] * (corner & 1 ? flat.half[0] : -flat.half[0]) +
                   flat.side[1] * (corner & 2 ? flat.half[1] : -flat.half[1]);
    at += flat.normal * (round.axis.dot(cap - at) / lean);
    if (at.distance2(cap) <= round.radius * round.radius) out.add(at);
  }
  const btVector3 across = round.axis.cross(reach);
  for (const btVector3& rim : {reach, across, -reach, -across}) {
    if (out.count < 4 && flat.isLevelWith(cap + rim)) out.add(cap + rim);
  }
  out.is_edge = out.count < 3;
  return out;
}

TouchCandidates findCandidates(const Round& round, const Flat& flat, btScalar foresight) {
  const btScalar lean = round.axis.dot(flat.normal);  // cosine of the angle to the normal
  btVector3 down = round.axis * lean - flat.normal;   // across the axis, towards the surface
  if (down.length2() > SIMD_EPSILON) {
    down.normalize();
  } else {
    btVector3 aside;
    btPlaneSpace1(round.axis, down, aside);
  }
  const btVector3 reach = round.is_capsule ? -flat.normal * round.radius : down * round.radius;
  const btVector3 lower = round.axis * (lean > 0 ? -round.half_length : round.half_length);
  const btScalar line_rise = 2 * round.half_length * std::abs(lean);
  const btScalar rim_rise = 2 * round.radius * std::sqrt(std::max<btScalar>(0, 1 - lean * lean));
  if (!round.is_capsule && rim_rise < std::min(line_rise, foresight)) {
    return findOnCap(round, flat, round.centre + lower, reach);
  }
  TouchCandidates out;
  btVector3 a = round.centre + lower + reach, b = round.centre - lower + reach;
  if (line_rise < foresight && clip(flat, &a, &b)) {
    out.is_line = true;
    out.add((a + b) / 2);
    out.add(a);
    out.add(b);
  } else {
    out.add(round.centre + lower + reach);
    out.is_edge = !flat.isLevelWith(out.at[0]);
  }
  return out;
}

/// The impulses of the contacts in the last step.
struct Load {
  int count = 0;
  btVector3 at[4];
  btScalar impulse[4];  // [N s]
};

Load loadOf(const btPersistentManifold& manifold) {
  Load load;
  for (; load.count < manifold.getNumContacts(); ++load.count) {
    const btManifoldPoint& point = manifold.getContactPoint(load.count);
    load.at[load.count] = point.getPositionWorldOnA();
    load.impulse[load.count] = point.getAppliedImpulse();
  }
  return load;
}

void addContact(const btCollisionObjectWrapper& round, const btCollisionObjectWrapper& flat,
                const Flat& surface, const btVector3& at, btPersistentManifold* manifold) {
  const btCollisionObject* a = round.getCollisionObject();
  const btCollisionObject* b = flat.getCollisionObject();
  const btScalar distance = surface.above(at);
  if (distance > manifold->getContactBreakingThreshold()) return;
  const btVector3 on_b = at - surface.normal * distance;
  btManifoldPoint point(a->getWorldTransform().invXform(at), b->getWorldTransform().invXform(on_b),
                        surface.normal, distance);
  point.m_positionWorldOnA = at;
  point.m_positionWorldOnB = on_b;
  point.m_combinedFriction = btManifoldResult::calculateCombinedFriction(a, b);
  point.m_combinedRestitution = btManifoldResult::calculateCombinedRestitution(a, b);
  btPlaneSpace1(point.m_normalWorldOnB, point.m_lateralFrictionDir1, point.m_lateralFrictionDir2);
  point.m_partId0 = round.m_partId;
  point.m_partId1 = flat.m_partId;
  point.m_index0 = round.m_index;
  point.m_index1 = flat.m_index;
  (*gContactAddedCallback)(point, &round, point.m_partId0, point.m_index0, &flat, point.m_partId1,
                           point.m_index1);
  manifold->addManifoldPoint(point);
}

/// Returns whether the round body is a tyre. Tyres are crowned and bear on their middle: between a
/// light wheel and a heavy chassis the solver would take too long to cancel the scrubbing of both
/// edges.
bool isTyre(const btPersistentManifold& manifold) {
  const btRigidBody* body = btRigidBody::upcast(manifold.getBody0());
  return body && body->getNumConstraintRefs() > 0;
}

/// Distributes the last load over the line, with its moment, since the solver hardly changes an
/// initial distribution.
void warmLine(const Load& load, btPersistentManifold* manifold) {
  const btVector3 middle = manifold->getContactPoint(0).getPositionWorldOnA();
  const btVector3 way = manifold->getContactPoint(2).getPositionWorldOnA() - middle;
  btScalar sum = 0, moment = 0;  // about the middle, per half of the length
  for (int i = 0; i < load.count; ++i) {
    sum += load.impulse[i];
    moment += load.impulse[i] * way.dot(load.at[i] - middle) / way.length2();
  }
  const btScalar end = isTyre(*manifold) ? 0 : kEndShare * sum;
  const btScalar tilt = std::clamp(moment / 2, -sum / 2, sum / 2);
  const btScalar first = std::max<btScalar>(0, end - tilt),
                 second = std::max<btScalar>(0, end + tilt);
  const btScalar share[3] = {sum - first - second, first, second};
  for (int i = 0; i < 3; ++i) {
    manifold->getContactPoint(i).m_appliedImpulse = i == 0 ? share[i] : share[i] / kWarmStart;
  }
}

/// Starts each point with the impulse that was there, or nearest to there.
void warmPoints(const Load& load, btPersistentManifold* manifold) {
  for (int i = 0; i < load.count; ++i) {
    int nearest = 0;
    btScalar least = kInfinity;
    for (int k = 0; k < manifold->getNumContacts(); ++k) {
      const btScalar far =
          (manifold->getContactPoint(k).getPositionWorldOnA() - load.at[i]).length2();
      if (far < least) {
        least = far;
        nearest = k;
      }
    }
    manifold->getContactPoint(nearest).m_appliedImpulse += load.impulse[i];
  }
}

}  // namespace

RoundContacts::RoundContacts(const btCollisionAlgorithmConstructionInfo& info,
                             const btCollisionObjectWrapper* round,
                             const btCollisionObjectWrapper* flat, bool is_swapped,
                             btCollisionAlgorithmCreateFunc* at_edges)
    : ContactAlgorithm(info, round, flat),
      is_swapped_(is_swapped),
      manifold_(
          m_dispatcher->getNewManifold(round->getCollisionObject(), flat->getCollisionObject())) {
  if (flat->getCollisionShape()->getShapeType() != BOX_SHAPE_PROXYTYPE) return;
  btCollisionAlgorithmConstructionInfo shared = info;
  shared.m_manifold = manifold_;
  edge_ = at_edges->CreateCollisionAlgorithm(shared, round, flat);
}

RoundContacts::~RoundContacts() {
  if (edge_) {
    edge_->~btCollisionAlgorithm();
    m_dispatcher->freeCollisionAlgorithm(edge_);
  }
  m_dispatcher->releaseManifold(manifold_);
}

void RoundContacts::processCollision(const btCollisionObjectWrapper* a,
                                     const btCollisionObjectWrapper* b,
                                     const btDispatcherInfo& info, btManifoldResult* result) {
  const btCollisionObjectWrapper& round = is_swapped_ ? *b : *a;
  const btCollisionObjectWrapper& flat = is_swapped_ ? *a : *b;
  const Round body(round);
  const Flat surface = edge_ ? faceOf(flat, body.centre) : planeOf(flat);
  const bool is_over = surface.isLevelWith(body.centre) && surface.above(body.centre) > 0;
  const TouchCandidates candidates =
      findCandidates(body, surface, manifold_->getContactBreakingThreshold());
  if (edge_ && (!is_over || candidates.is_edge)) {
    result->setPersistentManifold(manifold_);
    edge_->processCollision(&round, &flat, info, result);
    return result->refreshContactPoints();
  }
  const Load load = loadOf(*manifold_);
  manifold_->clearManifold();
  for (int i = 0; i < candidates.count; ++i) {
    addContact(round, flat, surface, candidates.at[i], manifold_);
  }
  if (manifold_->getNumContacts() == 0) return;
  if (candidates.is_line && manifold_->getNumContacts() == 3) {
    warmLine(load, manifold_);
  } else {
    warmPoints(load, manifold_);
  }
}

void RoundContacts::getAllContactManifolds(btManifoldArray& manifolds) {
  manifolds.push_back(manifold_);
}

btCollisionAlgorithm* RoundContacts::Creator::CreateCollisionAlgorithm(
    btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* a,
    const btCollisionObjectWrapper* b) {
  void* memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(RoundContacts));
  return m_swapped ? new (memory) RoundContacts(info, b, a, true, at_edges)
                   : new (memory) RoundContacts(info, a, b, false, at_edges);
}

}  // namespace kiva
