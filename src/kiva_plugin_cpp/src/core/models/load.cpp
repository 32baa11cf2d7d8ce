// SPDX-License-Identifier: Apache-2.0
#include "core/models/load.h"

#include <algorithm>
#include <cmath>

#include "core/contact/activation.h"
#include "core/geometry/footprint.h"
#include "core/models/models.h"
#include "core/motion/cruise.h"
#include "core/motion/jointed_body.h"

namespace kiva {
namespace {

constexpr double kAboveFloor = 0.05;  // [m]: what is lower is a leg's foot, not an underside
constexpr double kOnFloor = 0.005;    // [m]
constexpr double kUpright = 0.9999;   // cosine of a tilt of 0.8°

void loadRobot(WorldState& world, int robot, int unit) {
  Robot& r = world.fleet.robots[robot];
  const Pose in_robot = basePose(world, robot).Inverse() * unitPose(world, unit);
  SpatialInertia load;
  load.add(sumUnit(world, unit), in_robot);
  const Vector3 centre = load.centre();
  r.load_mass = world.units[unit].mass;
  r.load_centre[0] = centre.X();
  r.load_centre[1] = centre.Y();
  r.load_inertia =
      load.inertia()(2, 2) + load.mass() * (centre.X() * centre.X() + centre.Y() * centre.Y());
  Bounds box;
  const Model& model = *world.models[world.units[unit].model];
  for (const Link& link : model.description->links) {
    for (const Collision& c : link.collisions) {
      box.add(bounds(c.shape, in_robot * link.pose_in_model * c.pose_in_link));
    }
  }
  r.load_half_length = std::max(box.max.X(), -box.min.X());
  r.load_half_width = std::max(box.max.Y(), -box.min.Y());
}

}  // namespace

Pose basePose(const WorldState& world, int robot) {
  const Fleet& f = world.fleet;
  return Pose(f.x[robot], f.y[robot], 0, 0, 0, f.yaw[robot]);
}

Pose towerPose(const WorldState& world, int robot) {
  const Fleet& f = world.fleet;
  return basePose(world, robot) * Pose(0, 0, f.robots[robot].height + f.tower[robot], 0, 0, 0);
}

Pose unitPose(const WorldState& world, int unit) {
  const StorageUnit& u = world.units[unit];
  if (u.carrier >= 0) return towerPose(world, u.carrier) * u.pose_on_carrier;
  const Model& model = *world.models[u.model];
  if (!model.in_physics || !model.disturbed) return model.pose;
  return fromBullet(model.bodies.links.front().linkPose()) *
         model.description->links.front().pose_in_model.Inverse();
}

Pose itemPose(const WorldState& world, int item) {
  const Item& i = world.items[item];
  if (i.unit >= 0) return unitPose(world, i.unit) * i.pose_in_unit;
  return modelState(world, *world.models[i.model]).pose;
}

double underside(const WorldState& world, int unit) {
  const Model& model = *world.models[world.units[unit].model];
  double lowest = 1e9;
  for (const Link& link : model.description->links) {
    for (const Collision& c : link.collisions) {
      const Bounds box = bounds(c.shape, link.pose_in_model * c.pose_in_link);
      const bool over_centre = box.min.X() <= 0 && box.max.X() >= 0 && box.min.Y() <= 0 &&
                               box.max.Y() >= 0 && box.min.Z() > kAboveFloor;
      if (over_centre) lowest = std::min(lowest, box.min.Z());
    }
  }
  return lowest;
}

double towerGap(const WorldState& world, int robot, int unit) {
  return underside(world, unit) - world.fleet.robots[robot].height;
}

double unitDistance(const WorldState& world, int robot, int unit) {
  const Pose pose = unitPose(world, unit);
  return std::hypot(pose.X() - world.fleet.x[robot], pose.Y() - world.fleet.y[robot]);
}

void takeUp(WorldState& world, int robot, int unit) {
  StorageUnit& u = world.units[unit];
  Model& model = *world.models[u.model];
  if (model.in_physics) deactivate(world, model);
  u.pose_on_carrier = towerPose(world, robot).Inverse() * unitPose(world, unit);
  u.pose_on_carrier.Pos().Z() = -underside(world, unit);  // however far the tower went in a step
  u.carrier = robot;
  u.claimed_by = -1;
  world.fleet.unit[robot] = unit;
  loadRobot(world, robot, unit);
  rebuildBody(world, robot);
  updateFootprints(world, model);
  world.setStatus(robot, world.fleet.status[robot], world.fleet.state[robot]);
  ++world.units_revision;
}

void putDown(WorldState& world, int robot) {
  const int unit = world.fleet.unit[robot];
  StorageUnit& u = world.units[unit];
  Model& model = *world.models[u.model];
  const Pose pose = unitPose(world, unit);
  model.pose = Pose(pose.X(), pose.Y(), 0, 0, 0, pose.Rot().Yaw());
  u.carrier = -1;
  unload(world, robot);
  updateFootprints(world, model);
  ++world.units_revision;
}

void unload(WorldState& world, int robot) {
  Fleet& f = world.fleet;
  Robot& r = f.robots[robot];
  f.unit[robot] = -1;
  r.load_mass = r.load_inertia = r.load_half_length = r.load_half_width = 0;
  r.load_centre[0] = r.load_centre[1] = 0;
  f.awake[robot] = 1;  // its tower may have to come down
  stopCruise(f, robot);
  updateFootprints(world, world.modelOf(robot));
  rebuildBody(world, robot);
  world.setStatus(robot, f.status[robot], f.state[robot]);
}

bool standsUpright(const WorldState& world, int unit) {
  const Pose pose = unitPose(world, unit);
  return std::abs(pose.Z()) < kOnFloor && pose.Rot().ZAxis().Z() > kUpright;
}

int unitAt(const WorldState& world, const Vector3& point) {
  int found = -1;
  world.obstacles.near(point.X(), point.Y(), 0.0, [&](const Footprint& f) {
    const Model& model = *world.models[f.model];
    if (found >= 0 || model.kind != ModelKind::kStorageUnit) return;
    Footprint here;
    here.kind = Footprint::Kind::kCircle;
    here.x = point.X();
    here.y = point.Y();
    const bool inside = gap(f, here) <= 0 && point.Z() <= f.z_max && point.Z() >= f.z_min;
    if (inside) found = model.index;
  });
  return found;
}

void addMass(WorldState& world, int unit, double mass) {
  world.units[unit].mass += mass;
  const int carrier = world.units[unit].carrier;
  if (carrier < 0) return;
  loadRobot(world, carrier, unit);
  stopCruise(world.fleet, carrier);
  rebuildBody(world, carrier);
}

}  // namespace kiva
