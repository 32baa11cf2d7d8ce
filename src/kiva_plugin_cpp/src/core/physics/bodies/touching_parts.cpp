// SPDX-License-Identifier: Apache-2.0
#include "core/physics/bodies/touching_parts.h"

#include <algorithm>
#include <cmath>

namespace kiva {
namespace {

// Share of its depth by which a step lifts a body that could bounce; more would throw it. A body
// faster than kBouncing is not lifted: it leaves by itself.
constexpr double kGentle = 0.02;
constexpr double kBouncing = 0.2;  // [m/s]

const BodyPart* partOf(const btCollisionShape* shape) {
  return static_cast<const BodyPart*>(shape->getUserPointer());
}

/// Returns the part of a contact's shape. In a mesh that is a single triangle, which does not refer
/// to its part.
const BodyPart* partOf(const btCollisionObjectWrapper* wrapper) {
  for (; wrapper; wrapper = wrapper->m_parent) {
    if (const BodyPart* part = partOf(wrapper->getCollisionShape())) return part;
  }
  return nullptr;
}

/// Returns the relative speed of a contact's points along its normal [m/s].
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

}  // namespace

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

bool combineMaterials(btManifoldPoint& point, const btCollisionObjectWrapper* a, int, int,
                      const btCollisionObjectWrapper* b, int, int) {
  const BodyPart* part_a = partOf(a);
  const BodyPart* part_b = partOf(b);
  if (part_a && part_b) {
    point.m_combinedFriction = std::min(part_a->friction, part_b->friction);
    point.m_combinedRestitution = std::min(part_a->restitution, part_b->restitution);
    if (part_a->restitution > 0 ||
        part_b->restitution > 0) {  // not foreseen: they sink in slightly
      const bool bounces =
          point.m_combinedRestitution > 0 &&
          normalSpeed(point, a->getCollisionObject(), b->getCollisionObject()) > kBouncing;
      point.m_contactPointFlags |= BT_CONTACT_FLAG_HAS_CONTACT_ERP;
      point.m_contactERP = bounces ? 0 : kGentle;
    }
  }
  return true;
}

}  // namespace kiva
