// SPDX-License-Identifier: Apache-2.0
//
// The parts of bodies in a contact of Bullet.
#pragma once

#include <btBulletDynamicsCommon.h>

#include "core/physics/bodies/body_parts.h"

namespace kiva {

/// Returns the part of a body in a contact; null for a plane, which has one part only.
const BodyPart* touchedPart(const btCollisionObject* object, int part);
/// Returns the model of that part.
int modelOfPart(const btCollisionObject* object, int part);

/// Sets friction and restitution of a contact by its two parts: as in Gazebo, the smaller value of
/// both. Bullet calls this in every step that finds the contact.
bool combineMaterials(btManifoldPoint& point, const btCollisionObjectWrapper* a, int, int,
                      const btCollisionObjectWrapper* b, int, int);

}  // namespace kiva
