// SPDX-License-Identifier: Apache-2.0
//
// Converts poses and vectors of descriptions to those of Bullet, and back.
#pragma once

#include <btBulletDynamicsCommon.h>

#include "kiva_plugin_cpp/description.h"

namespace kiva {

btTransform toBullet(const Pose& pose);
btVector3 toBullet(const Vector3& v);
Pose fromBullet(const btTransform& transform);
Vector3 fromBullet(const btVector3& v);

}  // namespace kiva
