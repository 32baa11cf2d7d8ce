// SPDX-License-Identifier: Apache-2.0
#include "load.h"

#include <algorithm>
#include <cmath>

#include "cruise.h"
#include "engagement.h"
#include "footprint.h"
#include "models.h"

namespace kiva {
namespace {

constexpr double kAboveFloor = 0.05;  // [m]: what is lower is a leg's foot, not an underside
constexpr double kOnFloor = 0.005;    // [m]
constexpr double kUpright = 0.9999;   // cosine of a tilt of 0.8°

double inertiaAboutOrigin(const Parts& parts, int unit) {
  const Model& model = *parts.models[parts.units[unit].model];
  double inertia = 0;
  for (const Link& link : model.description->links) {
    const Pose centre = link.pose_in_model * link.inertial_pose_in_link;
    const Vector3 up = centre.Rot().RotateVectorReverse(Vector3::UnitZ);
    inertia += up.X() * up.X() * link.principal_moments.X() +
               up.Y() * up.Y() * link.principal_moments.Y() +
               up.Z() * up.Z() * link.principal_moments.Z() +
               link.mass * (centre.X() * centre.X() + centre.Y() * centre.Y());
  }
  for (const Item& item : parts.items) {
    if (item.unit != unit) continue;
    inertia +=
        item.mass * (std::pow(item.pose_in_unit.X(), 2) + std::pow(item.pose_in_unit.Y(), 2));
  }
  return inertia;
}

void loadRobot(Parts& parts, int robot, int unit) {
  Robot& r = parts.fleet.robots[robot];
  const Pose in_robot = basePose(parts, robot).Inverse() * unitPose(parts, unit);
  const double offset = in_robot.X() * in_robot.X() + in_robot.Y() * in_robot.Y();
  r.load_mass = parts.units[unit].mass;
  r.load_inertia = inertiaAboutOrigin(parts, unit) + r.load_mass * offset;
  Bounds box;
  const Model& model = *parts.models[parts.units[unit].model];
  for (const Link& link : model.description->links) {
    for (const Collision& c : link.collisions) {
      box.add(bounds(c.shape, in_robot * link.pose_in_model * c.pose_in_link));
    }
  }
  r.load_half_length = std::max(box.max.X(), -box.min.X());
  r.load_half_width = std::max(box.max.Y(), -box.min.Y());
}

}  // namespace

Pose basePose(const Parts& parts, int robot) {
  const Fleet& f = parts.fleet;
  return Pose(f.x[robot], f.y[robot], 0, 0, 0, f.yaw[robot]);
}

Pose towerPose(const Parts& parts, int robot) {
  const Fleet& f = parts.fleet;
  return basePose(parts, robot) * Pose(0, 0, f.robots[robot].height + f.tower[robot], 0, 0, 0);
}

Pose unitPose(const Parts& parts, int unit) {
  const StorageUnit& u = parts.units[unit];
  if (u.carrier >= 0) return towerPose(parts, u.carrier) * u.pose_on_carrier;
  const Model& model = *parts.models[u.model];
  if (!model.in_physics || !model.disturbed) return model.pose;
  return fromBullet(model.bodies.links.front().linkPose()) *
         model.description->links.front().pose_in_model.Inverse();
}

Pose itemPose(const Parts& parts, int item) {
  const Item& i = parts.items[item];
  if (i.unit >= 0) return unitPose(parts, i.unit) * i.pose_in_unit;
  return modelState(parts, *parts.models[i.model]).pose;
}

double underside(const Parts& parts, int unit) {
  const Model& model = *parts.models[parts.units[unit].model];
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

double towerGap(const Parts& parts, int robot, int unit) {
  return underside(parts, unit) - parts.fleet.robots[robot].height;
}

double unitDistance(const Parts& parts, int robot, int unit) {
  const Pose pose = unitPose(parts, unit);
  return std::hypot(pose.X() - parts.fleet.x[robot], pose.Y() - parts.fleet.y[robot]);
}

void takeUp(Parts& parts, int robot, int unit) {
  StorageUnit& u = parts.units[unit];
  Model& model = *parts.models[u.model];
  if (model.in_physics) disengage(parts, model);
  u.pose_on_carrier = towerPose(parts, robot).Inverse() * unitPose(parts, unit);
  u.pose_on_carrier.Pos().Z() = -underside(parts, unit);  // however far the tower went in a step
  u.carrier = robot;
  u.claimed_by = -1;
  parts.fleet.unit[robot] = unit;
  loadRobot(parts, robot, unit);
  rebuildBody(parts, robot);
  updateOutlines(parts, model);
  parts.setStatus(robot, parts.fleet.status[robot], parts.fleet.state[robot]);
  ++parts.units_revision;
}

void putDown(Parts& parts, int robot) {
  const int unit = parts.fleet.unit[robot];
  StorageUnit& u = parts.units[unit];
  Model& model = *parts.models[u.model];
  const Pose pose = unitPose(parts, unit);
  model.pose = Pose(pose.X(), pose.Y(), 0, 0, 0, pose.Rot().Yaw());
  u.carrier = -1;
  unload(parts, robot);
  updateOutlines(parts, model);
  ++parts.units_revision;
}

void unload(Parts& parts, int robot) {
  Fleet& f = parts.fleet;
  Robot& r = f.robots[robot];
  f.unit[robot] = -1;
  r.load_mass = r.load_inertia = r.load_half_length = r.load_half_width = 0;
  f.awake[robot] = 1;  // its tower may have to come down
  stopCruise(f, robot);
  updateOutlines(parts, parts.modelOf(robot));
  rebuildBody(parts, robot);
  parts.setStatus(robot, f.status[robot], f.state[robot]);
}

bool standsUpright(const Parts& parts, int unit) {
  const Pose pose = unitPose(parts, unit);
  return std::abs(pose.Z()) < kOnFloor && pose.Rot().ZAxis().Z() > kUpright;
}

int unitAt(const Parts& parts, const Vector3& point) {
  int found = -1;
  parts.obstacles.near(point.X(), point.Y(), 0.0, [&](const Footprint& f) {
    const Model& model = *parts.models[f.model];
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

void addMass(Parts& parts, int unit, double mass) {
  parts.units[unit].mass += mass;
  const int carrier = parts.units[unit].carrier;
  if (carrier < 0) return;
  loadRobot(parts, carrier, unit);
  stopCruise(parts.fleet, carrier);
  rebuildBody(parts, carrier);
}

}  // namespace kiva
