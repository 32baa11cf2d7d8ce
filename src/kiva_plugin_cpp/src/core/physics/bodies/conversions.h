// SPDX-License-Identifier: Apache-2.0
//
// Between poses and vectors of descriptions and those of Bullet.
#pragma once

#include <btBulletDynamicsCommon.h>

#include "kiva_plugin_cpp/description.h"

namespace kiva {

btTransform toBullet(const Pose& pose);
btVector3 toBullet(const Vector3& v);
Pose fromBullet(const btTransform& transform);
Vector3 fromBullet(const btVector3& v);

}  // namespace kiva
