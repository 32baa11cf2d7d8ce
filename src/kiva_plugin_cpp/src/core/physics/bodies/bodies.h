// SPDX-License-Identifier: Apache-2.0
//
// Builds links of a description as rigid bodies of Bullet.
#pragma once

#include <btBulletDynamicsCommon.h>

#include <memory>
#include <string>
#include <vector>

#include "core/physics/bodies/body_parts.h"
#include "core/physics/bodies/conversions.h"
#include "core/physics/collision/collision_groups.h"
#include "kiva_plugin_cpp/description.h"

namespace kiva {

/// Third user index of a body that was placed since the last step.
constexpr int kPlaced = 1;

/// The rigid body of a link. Bullet's body frame is at the centre of mass, along the principal
/// axes.
struct LinkBody {
  BodyShape shape;
  std::unique_ptr<BodyPart>
      surface;  ///< In place of `shape`, for an unbounded plane or a static mesh.
  std::unique_ptr<btRigidBody> body;
  btTransform mass_frame;  ///< Pose of the centre of mass in the link.
  int link = 0;
  int group = kDynamicGroup, mask = ~0;

  btTransform linkPose() const { return body->getWorldTransform() * mass_frame.inverse(); }
  void place(const btTransform& link_pose);
  /// Returns the velocity of the link's origin in world.
  btVector3 velocityAtOrigin() const;
};

struct ModelBodies {
  std::vector<LinkBody> links;     ///< One a link, in the description's order.
  std::vector<LinkBody> surfaces;  ///< The links' unbounded planes and static meshes.
  std::vector<std::unique_ptr<btTypedConstraint>> joints;
  std::vector<btJointFeedback> feedback;  ///< Forces of each joint in the last step.
};

/// Returns bodies of all links and joints of a model at `pose`, not yet in a world, and marked with
/// `model`.
ModelBodies buildBodies(const ModelDescription& description, const Pose& pose, int model, int group,
                        int mask);

}  // namespace kiva
