// SPDX-License-Identifier: Apache-2.0
//
// The parts of bodies that a contact of Bullet is between.
#pragma once

#include <btBulletDynamicsCommon.h>

#include "core/physics/bodies/body_parts.h"

namespace kiva {

/// Returns the part of a body that a contact is with; null for a plane, which has but one.
const BodyPart* touchedPart(const btCollisionObject* object, int part);
/// Returns the model of that part.
int modelOfPart(const btCollisionObject* object, int part);

/// Gives a contact the friction and restitution of the two parts that touch: as in Gazebo, the
/// smaller of both. Bullet calls this in every step that finds the contact.
bool combineMaterials(btManifoldPoint& point, const btCollisionObjectWrapper* a, int, int,
                      const btCollisionObjectWrapper* b, int, int);

}  // namespace kiva
