// SPDX-License-Identifier: Apache-2.0
#include "core/state/places/poses.h"

#include <algorithm>

namespace kiva {

Pose basePose(const Scene& world, int robot) {
  const Fleet& f = world.fleet;
  return Pose(f.x[robot], f.y[robot], world.floor.extent.z, 0, 0, f.yaw[robot]);
}

Pose towerPose(const Scene& world, int robot) {
  const Fleet& f = world.fleet;
  return basePose(world, robot) * Pose(0, 0, f.robots[robot].height + f.tower[robot], 0, 0, 0);
}

Pose unitPose(const Scene& world, int unit) {
  const StorageUnit& u = world.storage.units[unit];
  if (u.carrier >= 0) return towerPose(world, u.carrier) * u.pose_on_carrier;
  const Model& model = *world.models[u.model];
  return model.in_physics && model.disturbed ? canonicalState(model).pose : model.pose;
}

Pose itemPose(const Scene& world, int item) {
  const Item& i = world.storage.items[item];
  if (i.unit >= 0) return unitPose(world, i.unit) * i.pose_in_unit;
  return modelState(world, *world.models[i.model]).pose;
}

EntityState robotState(const Scene& world, int robot) {
  const Fleet& f = world.fleet;
  return {basePose(world, robot),
          {Vector3(f.vx[robot], f.vy[robot], 0), Vector3(0, 0, f.yaw_rate[robot])}};
}

EntityState modelState(const Scene& world, const Model& model) {
  return model.owner->state(world, model);
}

Pose linkPose(const Scene& world, const Model& model, int link) {
  return model.owner->linkPose(world, model, link);
}

EntityState linkState(const Scene& world, const Model& model, int link) {
  if (model.owner->followsBodies(model)) return bodyState(model.bodies.links[link]);
  return carriedState(modelState(world, model), linkPose(world, model, link));
}

EntityState bodyState(const LinkBody& link) {
  return {fromBullet(link.linkPose()),
          {fromBullet(link.velocityAtOrigin()), fromBullet(link.body->getAngularVelocity())}};
}

EntityState canonicalState(const Model& model) {
  EntityState state = bodyState(model.bodies.links.front());
  state.pose = state.pose * model.description->links.front().pose_in_model.Inverse();
  return state;
}

EntityState carriedState(const EntityState& carrier, const Pose& pose) {
  const Vector3 arm = pose.Pos() - carrier.pose.Pos();
  return {pose, {carrier.twist.linear + carrier.twist.angular.Cross(arm), carrier.twist.angular}};
}

}  // namespace kiva
