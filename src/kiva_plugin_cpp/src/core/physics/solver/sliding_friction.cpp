// SPDX-License-Identifier: Apache-2.0
#include "core/physics/solver/sliding_friction.h"

#include <cmath>
#include <utility>

namespace kiva {
namespace {

constexpr double kStands = 1e-9;  // [m/s]; a slower motion has no direction

}  // namespace

SlidingFriction::SlidingFriction(btRigidBody& body, std::vector<SlidingFoot> feet)
    : btTypedConstraint(MAX_CONSTRAINT_TYPE, body), feet_(std::move(feet)) {
  const btVector3 none(0, 0, 0);
  feedback_ = {none, none, none, none};
  setJointFeedback(&feedback_);
}

void SlidingFriction::getInfo1(btConstraintInfo1* info) {
  info->m_numConstraintRows = 2 * static_cast<int>(feet_.size());
  info->nub = 0;
}

btVector3 SlidingFriction::wayOf(const btVector3& arm) const {
  btVector3 along = getRigidBodyA().getVelocityInLocalPoint(arm);
  along.setZ(0);
  const double speed = along.length();
  return speed > kStands ? along / speed : btVector3(1, 0, 0);
}

void SlidingFriction::getInfo2(btConstraintInfo2* info) {
  const btRigidBody& body = getRigidBodyA();
  int row = 0;
  for (const SlidingFoot& foot : feet_) {
    const btVector3 arm = body.getWorldTransform().getBasis() * foot.at;
    const btVector3 along = wayOf(arm);
    for (const btVector3& way : {along, btVector3(-along.y(), along.x(), 0)}) {
      const int at = row++ * info->rowskip;
      const btVector3 turn = arm.cross(way);
      for (int axis = 0; axis < 3; ++axis) {
        info->m_J1linearAxis[at + axis] = way[axis];
        info->m_J1angularAxis[at + axis] = turn[axis];
      }
      info->m_constraintError[at] = 0;
      info->m_lowerLimit[at] = -foot.grip_limit / info->fps;
      info->m_upperLimit[at] = foot.grip_limit / info->fps;
    }
  }
}

}  // namespace kiva
