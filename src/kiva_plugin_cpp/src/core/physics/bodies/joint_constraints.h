// SPDX-License-Identifier: Apache-2.0
//
// Builds joints of a description as constraints of Bullet.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <memory>

#include "kiva_plugin_cpp/description.h"

namespace kiva {

/// The two bodies of a joint.
struct JointEnds {
  btRigidBody& parent;
  btRigidBody& child;
};

/// Returns the constraint of `joint` between its bodies at their present poses; `model` is the
/// model's pose in world.
std::unique_ptr<btTypedConstraint> makeJoint(const Joint& joint, const JointEnds& ends,
                                             const btTransform& model);

}  // namespace kiva
