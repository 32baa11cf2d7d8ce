// SPDX-License-Identifier: Apache-2.0
#include "core/physics/collision/planar_contacts.h"

#include <algorithm>
#include <cmath>
#include <new>
#include <optional>
#include <utility>

#include "core/geometry/footprint.h"

namespace kiva {
namespace {

constexpr btScalar kUpright = 1 - 1e-9;  // cosine of the largest tilt that counts as none

// Distance up to which a pair has a manifold. Contacts are foreseen up to half of it at most, which
// leaves the other half for the motion of a step.
constexpr btScalar kNear = 0.04;  // [m]

// Distance at which contacts are foreseen, besides the motion of both bodies in two steps, and its
// limit.
constexpr btScalar kClose = 0.002, kForeseen = 0.02;  // [m]

// Overlap of heights up to which a body stands on the other, or is pressed against its underside.
constexpr btScalar kOnTop = 0.001;  // [m]

// Largest distance of a point from the same point in the last step [m].
constexpr btScalar kSamePoint = 0.01;

const btCompoundShape& shapeOf(const btCollisionObjectWrapper* body) {
  return *static_cast<const btCompoundShape*>(body->getCollisionShape());
}

/// A part that stays upright, and its place.
struct Column {
  Rectangle outline;  ///< In its body's frame, so that it does not depend on the body's heading.
  btScalar z_min = 0, z_max = 0;  ///< In world [m].
  bool is_box = false;            ///< If not, the outline is that of its bounding box.
};

Rectangle outlineOf(const btBoxShape& box, const btTransform& pose) {
  const btVector3 ahead = pose.getBasis().getColumn(0), half = box.getHalfExtentsWithMargin();
  return {pose.getOrigin().x(), pose.getOrigin().y(), ahead.x(), ahead.y(), half.x(), half.y()};
}

bool isUpright(const btMatrix3x3& basis) { return basis[2][2] > kUpright; }

Column columnOf(const btCompoundShape& shape, int child, btScalar body_z) {
  const btTransform& pose = shape.getChildTransform(child);
  const btCollisionShape& part = *shape.getChildShape(child);
  Column column;
  btVector3 min, max;
  part.getAabb(pose, min, max);
  column.is_box = part.getShapeType() == BOX_SHAPE_PROXYTYPE && isUpright(pose.getBasis());
  if (column.is_box) {
    const auto& box = static_cast<const btBoxShape&>(part);
    column.outline = outlineOf(box, pose);
    min.setZ(pose.getOrigin().z() - box.getHalfExtentsWithMargin().z());
    max.setZ(pose.getOrigin().z() + box.getHalfExtentsWithMargin().z());
  } else {
    column.outline.x = (min.x() + max.x()) / 2;
    column.outline.y = (min.y() + max.y()) / 2;
    column.outline.hx = (max.x() - min.x()) / 2 - kForeseen;  // Bullet's box is padded
    column.outline.hy = (max.y() - min.y()) / 2 - kForeseen;
  }
  column.z_min = min.z() + body_z;
  column.z_max = max.z() + body_z;
  return column;
}

std::vector<Column> columnsOf(const btCollisionObjectWrapper* body) {
  std::vector<Column> columns;
  const btCompoundShape& shape = shapeOf(body);
  for (int i = 0; i < shape.getNumChildShapes(); ++i) {
    columns.push_back(columnOf(shape, i, body->getWorldTransform().getOrigin().z()));
  }
  return columns;
}

/// Returns whether both are side by side, and not only one on top of the other.
bool shareHeight(const Column& a, const Column& b) {
  return a.z_min + kOnTop < b.z_max && b.z_min + kOnTop < a.z_max;
}

/// Returns whether `outer` covers all of the area of `inner`.
bool covers(const Rectangle& outer, const Rectangle& inner) {
  const double dx = inner.x - outer.x, dy = inner.y - outer.y;
  const double c = std::abs(outer.c * inner.c + outer.s * inner.s);
  const double s = std::abs(outer.c * inner.s - outer.s * inner.c);
  return std::abs(outer.c * dx + outer.s * dy) + c * inner.hx + s * inner.hy <= outer.hx &&
         std::abs(outer.c * dy - outer.s * dx) + s * inner.hx + c * inner.hy <= outer.hy;
}

/// Returns whether `other` always touches a box of that body before it touches the part.
bool isBehindBox(const std::vector<Column>& body, std::size_t part, const Column& other) {
  for (std::size_t i = 0; i < body.size(); ++i) {
    const bool hides = i != part && body[i].is_box && shareHeight(body[i], other) &&
                       covers(body[i].outline, body[part].outline);
    if (hides) return true;
  }
  return false;
}

/// Returns the parts that could touch in any motion of the bodies; nothing if one of them is not an
/// upright box.
std::optional<std::vector<PlanarContacts::Pair>> findPairs(const std::vector<Column>& a,
                                                           const std::vector<Column>& b) {
  std::vector<PlanarContacts::Pair> pairs;
  for (std::size_t i = 0; i < a.size(); ++i) {
    for (std::size_t j = 0; j < b.size(); ++j) {
      if (!shareHeight(a[i], b[j])) continue;
      if (isBehindBox(a, i, b[j]) || isBehindBox(b, j, a[i])) continue;
      if (!a[i].is_box || !b[j].is_box) return std::nullopt;
      PlanarContacts::Pair pair;
      pair.a = static_cast<int>(i);
      pair.b = static_cast<int>(j);
      pair.z_min = std::max(a[i].z_min, b[j].z_min);
      pair.z_max = std::min(a[i].z_max, b[j].z_max);
      pairs.push_back(pair);
    }
  }
  return pairs;
}

/// Returns the bounding rectangle along the body's axes.
Rectangle hullOf(const std::vector<Column>& columns) {
  Bounds box;
  for (const Column& column : columns) {
    const Rectangle& r = column.outline;
    const btScalar c = std::abs(r.c), s = std::abs(r.s);
    const Vector3 half(c * r.hx + s * r.hy, s * r.hx + c * r.hy, 0), middle(r.x, r.y, 0);
    box.add({middle - half, middle + half});
  }
  const Vector3 middle = (box.min + box.max) * 0.5, half = (box.max - box.min) * 0.5;
  return {middle.X(), middle.Y(), 1, 0, half.X(), half.Y()};
}

bool staysUpright(const btCollisionObject& object) {
  const btRigidBody* body = btRigidBody::upcast(&object);
  return body && isUpright(body->getWorldTransform().getBasis()) &&
         (body->isStaticObject() || isPlanar(*body));
}

/// Returns the height of the centre of mass of the higher movable body, in world [m].
btScalar centreOf(const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b) {
  btScalar height = 0;
  for (const auto* body : {a, b}) {
    if (body->getCollisionObject()->isStaticObject()) continue;
    height = std::max(height, body->getWorldTransform().getOrigin().z());
  }
  return height;
}

/// Returns the largest speed of a point of the body [m/s].
btScalar speedOf(const btCollisionObject& object) {
  btVector3 centre;
  btScalar radius;
  object.getCollisionShape()->getBoundingSphere(centre, radius);
  const btRigidBody& body = *btRigidBody::upcast(&object);
  return body.getLinearVelocity().length() +
         std::abs(body.getAngularVelocity().z()) * (centre.length() + radius);
}

/// Returns the impulse near that point in the last step; 0 if there was none.
btScalar impulseNear(const btPersistentManifold& manifold, const btVector3& local_a) {
  for (int i = 0; i < manifold.getNumContacts(); ++i) {
    const btManifoldPoint& point = manifold.getContactPoint(i);
    if (point.m_localPointA.distance2(local_a) < kSamePoint * kSamePoint) {
      return point.m_appliedImpulse;
    }
  }
  return 0;
}

/// Returns Bullet's wrapper of a part of a body.
btCollisionObjectWrapper partOf(const btCollisionObjectWrapper* body, int child) {
  return {body,
          shapeOf(body).getChildShape(child),
          body->getCollisionObject(),
          body->getWorldTransform(),
          -1,
          child};
}

btManifoldPoint pointAt(const OutlineContact& contact, btScalar height,
                        const btCollisionObjectWrapper& a, const btCollisionObjectWrapper& b) {
  const btVector3 on_b(contact.x, contact.y, height), normal(contact.nx, contact.ny, 0);
  const btVector3 on_a = on_b + normal * contact.distance;
  btManifoldPoint point(a.getWorldTransform().invXform(on_a), b.getWorldTransform().invXform(on_b),
                        normal, contact.distance);
  point.m_positionWorldOnA = on_a;
  point.m_positionWorldOnB = on_b;
  point.m_lateralFrictionDir1 = {-normal.y(), normal.x(), 0};
  point.m_lateralFrictionDir2 = {0, 0, 1};
  point.m_partId0 = point.m_partId1 = -1;
  point.m_index0 = a.m_index;
  point.m_index1 = b.m_index;
  gContactAddedCallback(point, &a, -1, point.m_index0, &b, -1, point.m_index1);
  return point;
}

/// Replaces the points of the last step.
void setPoints(const PlanarContacts::Pair& pair, btScalar height,
               const btCollisionObjectWrapper* body_a, const btCollisionObjectWrapper* body_b) {
  const OutlineContacts& contacts = pair.contacts;
  const btCollisionObjectWrapper a = partOf(body_a, pair.a), b = partOf(body_b, pair.b);
  btManifoldPoint points[2];
  for (int i = 0; i < contacts.count; ++i) {
    points[i] = pointAt(contacts.at[i], height, a, b);
    points[i].m_appliedImpulse = impulseNear(*pair.manifold, points[i].m_localPointA);
  }
  pair.manifold->clearManifold();
  for (int i = 0; i < contacts.count; ++i) pair.manifold->addManifoldPoint(points[i]);
}

/// Returns an outline in world that is in the frame of an upright body.
Rectangle inWorld(const btCollisionObjectWrapper* body, const Rectangle& in_body) {
  const btTransform& pose = body->getWorldTransform();
  const btScalar c = pose.getBasis()[0][0], s = pose.getBasis()[1][0];
  return {pose.getOrigin().x() + c * in_body.x - s * in_body.y,
          pose.getOrigin().y() + s * in_body.x + c * in_body.y,
          c * in_body.c - s * in_body.s,
          s * in_body.c + c * in_body.s,
          in_body.hx,
          in_body.hy};
}

Rectangle partOutline(const btCollisionObjectWrapper* body, int child) {
  const btCompoundShape& shape = shapeOf(body);
  return inWorld(body, outlineOf(static_cast<const btBoxShape&>(*shape.getChildShape(child)),
                                 shape.getChildTransform(child)));
}

/// Returns whether two outlines may be within that distance [m].
bool mayBeWithin(btScalar distance, const Rectangle& a, const Rectangle& b) {
  const btScalar dx = b.x - a.x, dy = b.y - a.y;
  const btScalar near =
      std::sqrt(a.hx * a.hx + a.hy * a.hy) + std::sqrt(b.hx * b.hx + b.hy * b.hy) + distance;
  return dx * dx + dy * dy < near * near;
}

}  // namespace

bool isPlanar(const btRigidBody& body) {
  return !body.isStaticOrKinematicObject() && body.getLinearFactor() == btVector3(1, 1, 0) &&
         body.getAngularFactor() == btVector3(0, 0, 1);
}

PlanarContacts::PlanarContacts(const btCollisionAlgorithmConstructionInfo& info,
                               const btCollisionObjectWrapper* a, const btCollisionObjectWrapper* b,
                               std::vector<Pair> pairs, const Rectangle& hull_a,
                               const Rectangle& hull_b)
    : ContactAlgorithm(info, a, b), pairs_(std::move(pairs)), hull_a_(hull_a), hull_b_(hull_b) {}

PlanarContacts::~PlanarContacts() {
  for (Pair& pair : pairs_) {
    if (pair.manifold) m_dispatcher->releaseManifold(pair.manifold);
  }
}

void PlanarContacts::processCollision(const btCollisionObjectWrapper* a,
                                      const btCollisionObjectWrapper* b,
                                      const btDispatcherInfo& info, btManifoldResult*) {
  if (areFarther(kNear, inWorld(a, hull_a_), inWorld(b, hull_b_))) return forget();
  const btCollisionObject &body_a = *a->getCollisionObject(), &body_b = *b->getCollisionObject();
  const btScalar reach =
      std::min(kForeseen, kClose + 2 * (speedOf(body_a) + speedOf(body_b)) * info.m_timeStep);
  bool any = false;
  for (Pair& pair : pairs_) any = findPairContacts(a, b, reach, &pair) || any;
  const btScalar height = any ? heightOfPush(centreOf(a, b)) : 0;
  for (Pair& pair : pairs_) {
    if (!pair.manifold) continue;
    if (pair.contacts.count == 0) {
      pair.manifold->clearManifold();
    } else {
      setPoints(pair, height, a, b);
    }
  }
}

bool PlanarContacts::findPairContacts(const btCollisionObjectWrapper* a,
                                      const btCollisionObjectWrapper* b, double reach, Pair* pair) {
  pair->contacts.count = 0;
  const Rectangle on_a = partOutline(a, pair->a), on_b = partOutline(b, pair->b);
  if (!mayBeWithin(kNear, on_a, on_b)) return false;
  if (!pair->manifold) {
    pair->manifold = m_dispatcher->getNewManifold(a->getCollisionObject(), b->getCollisionObject());
    pair->manifold->m_companionIdA = pair->a;
    pair->manifold->m_companionIdB = pair->b;
  }
  pair->contacts = findContacts(on_a, on_b, reach);
  return pair->contacts.count > 0;
}

/// Returns the height at which the force acts. Faces that press on each other keep the bodies
/// upright, so that it acts as near to the centre of mass as the faces reach.
double PlanarContacts::heightOfPush(double centre) const {
  double z_min = centre, z_max = centre;
  bool is_first = true;
  for (const Pair& pair : pairs_) {
    if (pair.contacts.count == 0) continue;
    z_min = is_first ? pair.z_min : std::min(z_min, pair.z_min);
    z_max = is_first ? pair.z_max : std::max(z_max, pair.z_max);
    is_first = false;
  }
  return std::clamp(centre, z_min, z_max);
}

void PlanarContacts::forget() {
  for (Pair& pair : pairs_) {
    if (pair.manifold) pair.manifold->clearManifold();
  }
}

void PlanarContacts::getAllContactManifolds(btManifoldArray& manifolds) {
  for (const Pair& pair : pairs_) {
    if (pair.manifold) manifolds.push_back(pair.manifold);
  }
}

btCollisionAlgorithm* PlanarContacts::Creator::CreateCollisionAlgorithm(
    btCollisionAlgorithmConstructionInfo& info, const btCollisionObjectWrapper* a,
    const btCollisionObjectWrapper* b) {
  static_assert(sizeof(PlanarContacts) <= sizeof(btCompoundCompoundCollisionAlgorithm),
                "what a dispatcher allocates is no larger than Bullet's own");
  if (staysUpright(*a->getCollisionObject()) && staysUpright(*b->getCollisionObject())) {
    const std::vector<Column> of_a = columnsOf(a), of_b = columnsOf(b);
    if (auto pairs = findPairs(of_a, of_b)) {
      void* memory = info.m_dispatcher1->allocateCollisionAlgorithm(sizeof(PlanarContacts));
      return new (memory) PlanarContacts(info, a, b, std::move(*pairs), hullOf(of_a), hullOf(of_b));
    }
  }
  return CreateFunc::CreateCollisionAlgorithm(info, a, b);
}

}  // namespace kiva
