// SPDX-License-Identifier: Apache-2.0
#include "core/models/ordinary_models.h"

#include <algorithm>

#include "core/models/floors.h"
#include "core/motion/joints/joints.h"
#include "core/state/people/people.h"
#include "core/state/places/floors.h"
#include "core/state/places/footprints.h"
#include "core/state/places/poses.h"

namespace kiva {
namespace {

void insertBodies(const Scene& world, Physics& physics, Model& model) {
  model.bodies = model.owner->build(world, model);
  physics.insert(model.bodies);
  model.in_physics = true;
}

}  // namespace

void setBodyState(LinkBody& link, const EntityState& to) {
  link.place(toBullet(to.pose));
  const Vector3 arm = fromBullet(link.body->getWorldTransform().getOrigin()) - to.pose.Pos();
  link.body->setLinearVelocity(toBullet(to.twist.linear + to.twist.angular.Cross(arm)));
  link.body->setAngularVelocity(toBullet(to.twist.angular));
  link.body->activate(true);
}

void moveBodies(Model& model, const EntityState& to) {
  const Pose way = to.pose * canonicalState(model).pose.Inverse();
  for (LinkBody& link : model.bodies.links) {
    const Pose pose = way * fromBullet(link.linkPose());
    setBodyState(link, carriedState(to, pose));
  }
}

void setModelTwist(Model& model, const Twist& twist) {
  const EntityState now = bodyState(model.bodies.links.front());
  const btVector3 origin = toBullet(now.pose.Pos());
  const btVector3 push = toBullet(twist.linear - now.twist.linear);
  const btVector3 turn = toBullet(twist.angular - now.twist.angular);
  constexpr double kRest = 1e-3;  // [m/s, rad/s]
  const bool moves =
      !twist.linear.Equal(Vector3::Zero, kRest) || !twist.angular.Equal(Vector3::Zero, kRest);
  for (LinkBody& link : model.bodies.links) {
    btRigidBody& body = *link.body;
    const btVector3 arm = body.getWorldTransform().getOrigin() - origin;
    body.setLinearVelocity(body.getLinearVelocity() + push + turn.cross(arm));
    body.setAngularVelocity(body.getAngularVelocity() + turn);
    if (moves) body.activate(true);
  }
}

void OrdinaryModels::add(ModelView& world, Model& model) const {
  insertBodies(world, world.physics, model);
  if (!model.isStatic()) {
    world.models.bodies.push_back(model.slot);
    initJoints(model);
  }
  addCollisionGeometry(world.floor, model);
  if (model.isStatic()) measureFloor(world);
}

void OrdinaryModels::remove(ModelView& world, Model& model) const {
  auto& slots = world.models.bodies;
  slots.erase(std::remove(slots.begin(), slots.end(), model.slot), slots.end());
  const bool may_be_floor = !model.level_surfaces.empty();
  model.level_surfaces.clear();
  if (may_be_floor) measureFloor(world);
}

void OrdinaryModels::place(ModelView& world, Model& model, const EntityState& state) const {
  if (!model.isStatic()) {
    if (!model.bodies.links.empty()) moveBodies(model, state);
    return;
  }
  world.physics.remove(model.bodies);
  model.pose = state.pose;
  insertBodies(world, world.physics, model);
  refitGeometry(world, model);
  measureFloor(world);
}

void OrdinaryModels::reset(ModelView& world, Model& model) const {
  if (!followsBodies(model)) return place(world, model, {model.spawn_pose, {}});
  world.physics.remove(model.bodies);  // with its joints: the model is rebuilt
  model.pose = model.spawn_pose;
  insertBodies(world, world.physics, model);
  initJoints(model);
}

EntityState OrdinaryModels::state(const Scene& world, const Model& model) const {
  if (followsBodies(model)) return canonicalState(model);
  return {model.pose, world.people.twist(model.slot)};
}

Pose OrdinaryModels::linkPose(const Scene& /*world*/, const Model& model, int link) const {
  if (followsBodies(model)) return fromBullet(model.bodies.links[link].linkPose());
  return model.pose * model.description->links[link].pose_in_model;
}

void OrdinaryModels::reweigh(ContactView& world, Model& model, double /*added*/) const {
  if (!followsBodies(model)) return;
  std::vector<EntityState> states;
  for (const LinkBody& link : model.bodies.links) states.push_back(bodyState(link));
  world.physics.remove(model.bodies);
  model.bodies = build(world, model);
  for (std::size_t i = 0; i < states.size(); ++i) setBodyState(model.bodies.links[i], states[i]);
  world.physics.insert(model.bodies);
  restoreLimits(model);
}

bool OrdinaryModels::push(ContactView& /*world*/, Model& model, int link, const Vector3& /*at*/,
                          const Vector3& force, const Vector3& torque) const {
  if (link >= static_cast<int>(model.bodies.links.size())) return false;
  btRigidBody& body = *model.bodies.links[link].body;
  body.activate(true);
  body.applyCentralForce(toBullet(force));
  body.applyTorque(toBullet(torque));
  return true;
}

ModelBodies OrdinaryModels::build(const Scene& world, const Model& model) const {
  if (model.isStatic()) return buildStatic(world, model);
  return world.physics.build(*model.description, model.spawn_pose, model.slot, kDynamicGroup, ~0);
}

}  // namespace kiva
