// SPDX-License-Identifier: Apache-2.0
#include "core/models/load.h"

#include <algorithm>
#include <cmath>

#include "core/contact/activation.h"
#include "core/motion/joints/jointed_body.h"
#include "core/state/places/footprints.h"
#include "core/state/places/poses.h"
#include "core/state/places/unit_geometry.h"
#include "core/state/progress/tasks.h"

namespace kiva {
namespace {

constexpr char kTowerLink[] = "tower";
constexpr double kGuided =
    0.02;  // largest offset [m] and angle [rad] that the tower's guide corrects

/// Returns the shortest distance from the centre to an edge of the plate that loads stand on, or of
/// the chassis without a plate [m].
double plateReach(const Scene& world, int robot) {
  const Robot& r = world.fleet.robots[robot];
  Bounds box;
  bool has_plate = false;
  for (const Link& link : world.models.of(world.fleet.robots[robot]).description->links) {
    if (link.name != kTowerLink) continue;
    for (const Collision& c : link.collisions) box.add(bounds(c.shape, c.pose_in_link));
    has_plate = has_plate || !link.collisions.empty();
  }
  if (!has_plate) return std::min(r.half_length, r.half_width);
  return std::min({box.max.X(), -box.min.X(), box.max.Y(), -box.min.Y()});
}

/// Sets the foothold of a load on the plate, from its inertia and underside in the robot's frame.
void setFoothold(RobotView& world, int robot, const SpatialInertia& load, double underside) {
  Robot& r = world.fleet.robots[robot];
  const Vector3 centre = load.centre();
  const double off = std::hypot(centre.X(), centre.Y());
  r.load_height = centre.Z() - underside;
  r.load_foothold = std::max(0.0, plateReach(world, robot) - off);
  const double arm2 = r.load_height * r.load_height + r.load_foothold * r.load_foothold;
  const auto own = load.inertia();
  r.load_tipping_inertia = r.load_mass * arm2 + std::max(own(0, 0), own(1, 1));
}

void loadRobot(RobotView& world, int robot, int unit) {
  Robot& r = world.fleet.robots[robot];
  const Pose in_robot = basePose(world, robot).Inverse() * unitPose(world, unit);
  SpatialInertia load;
  load.add(sumUnit(world, unit), in_robot);
  const Vector3 centre = load.centre();
  r.load_mass = world.storage.units[unit].mass;
  r.load_centre[0] = centre.X();
  r.load_centre[1] = centre.Y();
  r.load_inertia = load.aboutZ();
  setFoothold(world, robot, load, in_robot.Pos().Z() + underside(world, unit));
  Bounds box;
  const Model& model = *world.models[world.storage.units[unit].model];
  for (const Link& link : model.description->links) {
    for (const Collision& c : link.collisions) {
      box.add(bounds(c.shape, in_robot * link.pose_in_model * c.pose_in_link));
    }
  }
  r.load_half_length = std::max(box.max.X(), -box.min.X());
  r.load_half_width = std::max(box.max.Y(), -box.min.Y());
}

/// Centres a unit on the tower by its guide. Robots with estimated poses would otherwise put it
/// down a little farther off its place each time.
void centre(Pose* on_tower) {
  const double square = std::round(on_tower->Rot().Yaw() / (M_PI / 2)) * M_PI / 2;
  const double off = std::hypot(on_tower->X(), on_tower->Y());
  if (off > kGuided || std::abs(on_tower->Rot().Yaw() - square) > kGuided) return;
  *on_tower = Pose(0, 0, on_tower->Z(), 0, 0, square);
}

}  // namespace

void takeUp(ContactView& world, int robot, int unit) {
  StorageUnit& u = world.storage.units[unit];
  Model& model = *world.models[u.model];
  if (model.in_physics) deactivate(world, model);
  u.pose_on_carrier = towerPose(world, robot).Inverse() * unitPose(world, unit);
  u.pose_on_carrier.Pos().Z() =
      -underside(world, unit);  // even if the tower has moved farther within a step
  if (world.fleet.localises) centre(&u.pose_on_carrier);
  u.carrier = robot;
  u.claimed_by = -1;
  world.fleet.unit[robot] = unit;
  loadRobot(world, robot, unit);
  moved(world.fleet, robot);
  moved(world, model);
  rebuildBody(world, world.models.of(world.fleet.robots[robot]));
  setStatus(world, robot, world.fleet.status[robot], world.fleet.state[robot]);
}

void putDown(ContactView& world, int robot) {
  const int unit = world.fleet.unit[robot];
  StorageUnit& u = world.storage.units[unit];
  Model& model = *world.models[u.model];
  const Pose pose = unitPose(world, unit);
  model.pose = Pose(pose.X(), pose.Y(), world.floor.extent.z, 0, 0, pose.Rot().Yaw());
  u.carrier = -1;
  unload(world, robot);
  moved(world, model);
}

void unload(ContactView& world, int robot) {
  FleetState& f = world.fleet;
  Robot& r = f.robots[robot];
  f.unit[robot] = -1;
  r.load_mass = r.load_inertia = r.load_half_length = r.load_half_width = 0;
  r.load_centre[0] = r.load_centre[1] = 0;
  r.load_height = r.load_foothold = r.load_tipping_inertia = 0;
  f.sway[robot] = {};
  moved(world.fleet, robot);  // its tower may have to come down
  moved(world, world.models.of(world.fleet.robots[robot]));
  rebuildBody(world, world.models.of(world.fleet.robots[robot]));
  setStatus(world, robot, f.status[robot], f.state[robot]);
}

double overhang(const Scene& world, int robot, int unit) {
  const Pose in_robot = basePose(world, robot).Inverse() * unitPose(world, unit);
  SpatialInertia load;
  load.add(sumUnit(world, unit), in_robot);
  const Vector3 centre = load.centre();
  return std::hypot(centre.X(), centre.Y()) - plateReach(world, robot);
}

void addMass(ContactView& world, int unit, double mass) {
  world.storage.units[unit].mass += mass;
  const int carrier = world.storage.units[unit].carrier;
  if (carrier < 0) return;
  loadRobot(world, carrier, unit);
  moved(world.fleet, carrier);
  rebuildBody(world, world.models.of(world.fleet.robots[carrier]));
}

double massOf(const ModelDescription& description) {
  double mass = 0;
  for (const Link& link : description.links) mass += link.mass;
  return mass;
}

}  // namespace kiva
