// SPDX-License-Identifier: Apache-2.0
#include "core/physics/bodies/bodies.h"

#include <algorithm>
#include <utility>

#include "core/physics/bodies/joint_constraints.h"
#include "core/physics/solver/ordered_bullet.h"

namespace kiva {
namespace {

// Speed below which a body falls asleep after two seconds; Bullet's own 0.8 m/s would stop a
// pendulum.
constexpr double kAsleep = 0.005;  // [m/s, rad/s]

/// The data that the bodies of one model share.
struct BodyContext {
  bool is_static;
  btTransform model_pose;
  int model;
  int group, mask;
};

LinkBody finishBody(LinkBody body, const Link& link, const BodyContext& context,
                    btCollisionShape* shape) {
  const bool moves = !context.is_static;
  btRigidBody::btRigidBodyConstructionInfo info(
      moves ? link.mass : 0, nullptr, shape,
      moves ? toBullet(link.principal_moments) : btVector3(0, 0, 0));
  body.group = context.group | (link.self_collide ? kSelfCollidingGroup : 0);
  body.mask = context.mask;
  body.body = std::make_unique<btRigidBody>(info);
  body.body->setUserIndex(context.model);
  body.body->setCollisionFlags(body.body->getCollisionFlags() |
                               btCollisionObject::CF_CUSTOM_MATERIAL_CALLBACK);
  body.body->setSleepingThresholds(kAsleep, kAsleep);
  if (!link.gravity) body.body->setFlags(body.body->getFlags() | BT_DISABLE_WORLD_GRAVITY);
  body.place(context.model_pose * toBullet(link.pose_in_model));
  return body;
}

LinkBody makeSurface(const Link& link, int index, const Collision& surface,
                     const BodyContext& context) {
  LinkBody out;
  out.link = index;
  out.mass_frame = toBullet(surface.pose_in_link);
  out.surface = makePart(surface, context.model, context.is_static);
  btCollisionShape* shape = out.surface->shape.get();
  return finishBody(std::move(out), link, context, shape);
}

LinkBody makeBody(const Link& link, int index, const BodyContext& context) {
  LinkBody out;
  out.link = index;
  out.mass_frame =
      context.is_static ? btTransform::getIdentity() : toBullet(link.inertial_pose_in_link);
  const btTransform in_body = out.mass_frame.inverse();
  for (const Collision& collision : link.collisions) {
    if (isSurface(collision, context.is_static)) continue;
    out.shape.add(collision, in_body * toBullet(collision.pose_in_link), context.model);
  }
  btCollisionShape* shape = out.shape.compound.get();
  LinkBody body = finishBody(std::move(out), link, context, shape);
  // A foreseen contact would slow a body down before it could bounce.
  const bool bounces = std::any_of(link.collisions.begin(), link.collisions.end(),
                                   [](const Collision& c) { return c.restitution > 0; });
  if (bounces) body.body->setContactProcessingThreshold(0);
  return body;
}

btRigidBody& bodyOf(const ModelDescription& description, ModelBodies& bodies,
                    const std::string& link) {
  for (std::size_t i = 0; i < description.links.size(); ++i) {
    if (description.links[i].name == link) return *bodies.links[i].body;
  }
  return btTypedConstraint::getFixedBody();  // "world"
}

}  // namespace

void LinkBody::place(const btTransform& link_pose) {
  const btTransform pose = link_pose * mass_frame;
  body->setWorldTransform(pose);
  body->setInterpolationWorldTransform(pose);
  body->updateInertiaTensor();
  body->setUserIndex3(kPlaced);
}

btVector3 LinkBody::velocityAtOrigin() const {
  const btVector3 arm = linkPose().getOrigin() - body->getWorldTransform().getOrigin();
  return body->getVelocityInLocalPoint(arm);
}

ModelBodies buildBodies(const ModelDescription& description, const Pose& pose, int model, int group,
                        int mask) {
  ModelBodies out;
  const BodyContext context{description.is_static, toBullet(pose), model, group, mask};
  for (std::size_t i = 0; i < description.links.size(); ++i) {
    const Link& link = description.links[i];
    out.links.push_back(makeBody(link, static_cast<int>(i), context));
    for (const Collision& collision : link.collisions) {
      if (!isSurface(collision, description.is_static)) continue;
      out.surfaces.push_back(makeSurface(link, static_cast<int>(i), collision, context));
    }
  }
  if (description.is_static) return out;
  const btVector3 none(0, 0, 0);
  out.feedback.assign(description.joints.size(), {none, none, none, none});
  for (const Joint& joint : description.joints) {
    const JointEnds ends{bodyOf(description, out, joint.parent),
                         bodyOf(description, out, joint.child)};
    out.joints.push_back(makeJoint(joint, ends, toBullet(pose)));
    out.joints.back()->setJointFeedback(&out.feedback[out.joints.size() - 1]);
    mark(*out.joints.back(), model, static_cast<int>(out.joints.size()));
  }
  return out;
}

}  // namespace kiva
