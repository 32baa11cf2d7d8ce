// SPDX-License-Identifier: Apache-2.0
#include "core/physics/bodies/conversions.h"

namespace kiva {

btVector3 toBullet(const Vector3& v) { return {v.X(), v.Y(), v.Z()}; }
Vector3 fromBullet(const btVector3& v) { return {v.x(), v.y(), v.z()}; }

btTransform toBullet(const Pose& pose) {
  const Quaternion& q = pose.Rot();
  return btTransform(btQuaternion(q.X(), q.Y(), q.Z(), q.W()), toBullet(pose.Pos()));
}

Pose fromBullet(const btTransform& transform) {
  const btQuaternion q = transform.getRotation();
  return Pose(fromBullet(transform.getOrigin()), Quaternion(q.w(), q.x(), q.y(), q.z()));
}

}  // namespace kiva
