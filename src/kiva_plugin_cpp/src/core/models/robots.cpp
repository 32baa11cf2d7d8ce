// SPDX-License-Identifier: Apache-2.0
#include "core/models/robots.h"

#include <algorithm>
#include <cmath>

#include "core/contact/activation.h"
#include "core/control/commands.h"
#include "core/geometry/footprint.h"
#include "core/models/load.h"
#include "core/models/models.h"
#include "core/motion/cruise.h"
#include "core/motion/jointed_body.h"
#include "core/sensing/sensing.h"
#include "plugins/fleet_plugin.h"

namespace kiva {
namespace {

constexpr char kMotionPlugin[] = "libkiva_motion.so";
constexpr double kUprightAngle = 1e-3;  // [rad]
constexpr double kNearFloor = 1.0;      // [m]: from where a spawned robot is put on the floor

int idIn(const std::string& name) {
  const std::string digits = name.rfind("kiva", 0) == 0 ? name.substr(4) : "";
  const bool number = !digits.empty() && digits.size() <= 7 && digits[0] != '0' &&
                      digits.find_first_not_of("0123456789") == std::string::npos;
  const int id = number ? std::stoi(digits) : 0;
  if (id < 1 || id > kMaxKivaId) {
    throw DescriptionError("model '" + name +
                           "': a robot is called kiva<id> with an id from 1 to " +
                           std::to_string(kMaxKivaId));
  }
  return id;
}

void checkPose(const Model& model) {
  const Vector3 euler = model.pose.Rot().Euler();
  if (std::abs(euler.X()) > kUprightAngle || std::abs(euler.Y()) > kUprightAngle) {
    throw DescriptionError("model '" + model.name + "': a robot must stand upright, not at roll " +
                           std::to_string(euler.X()) + ", pitch " + std::to_string(euler.Y()));
  }
  if (std::abs(model.pose.Z()) > kNearFloor) {
    throw DescriptionError("model '" + model.name + "': a robot stands on the floor, not at z = " +
                           std::to_string(model.pose.Z()) + " m");
  }
}

Shape measure(const ModelDescription& description, Robot* robot, Pose* centre) {
  const Bounds box = bounds(description);
  if (box.empty()) throw DescriptionError("a robot needs a collision shape");
  const double reach_x = std::max(box.max.X(), -box.min.X());
  const double reach_y = std::max(box.max.Y(), -box.min.Y());
  robot->half_length = reach_x;
  robot->half_width = reach_y;
  robot->height = box.max.Z();
  Shape shape;
  shape.size = box.max - box.min;
  *centre = Pose((box.max + box.min) * 0.5, Quaternion::Identity);
  return shape;
}

void configure(const WorldState& world, const ModelDescription& description, Robot* robot) {
  for (const PluginDescription& plugin : description.plugins) {
    const FleetPlugin* ours = findFleetPlugin(world, plugin.filename);
    if (!ours) continue;
    ours->configure(*robot, plugin.parameters);
    plugin.parameters.rejectUnread();
  }
  if (world.options.drive) robot->drive.drive = *world.options.drive;
}

/// What is stored by index follows a robot that got another one.
void reindex(WorldState& world, int from, int to) {
  Model& model = world.modelOf(to);
  model.index = to;
  for (StorageUnit& unit : world.units) {
    if (unit.carrier == from) unit.carrier = to;
    if (unit.claimed_by == from) unit.claimed_by = to;
  }
  updateFootprints(world, model);
}

/// Of the tyres, where the model has wheels.
void setTyres(const ModelDescription& description, Robot* robot) {
  const char* const wheels[] = {"left_wheel", "right_wheel"};
  for (int side = 0; side < 2; ++side) {
    const Link* wheel = description.findLink(wheels[side]);
    if (wheel) robot->tyre_friction[side] = tyreFriction(*wheel);
  }
}

}  // namespace

bool isRobot(const ModelDescription& description) {
  return std::any_of(description.plugins.begin(), description.plugins.end(),
                     [](const PluginDescription& p) { return p.filename == kMotionPlugin; });
}

void weighRobot(const ModelDescription& description, Robot* robot) {
  robot->mass = robot->inertia = robot->centre[0] = robot->centre[1] = 0;
  for (const Link& link : description.links) {
    const Pose centre = link.pose_in_model * link.inertial_pose_in_link;
    const Vector3 up = centre.Rot().RotateVectorReverse(Vector3::UnitZ);
    const double own = up.X() * up.X() * link.principal_moments.X() +
                       up.Y() * up.Y() * link.principal_moments.Y() +
                       up.Z() * up.Z() * link.principal_moments.Z();
    for (int axis = 0; axis < 2; ++axis) {
      robot->centre[axis] += link.mass * centre.Pos()[axis];
    }
    robot->mass += link.mass;
    robot->inertia += own + link.mass * (centre.X() * centre.X() + centre.Y() * centre.Y());
  }
  for (double& moment : robot->centre) moment /= robot->mass;
}

void addRobot(WorldState& world, int slot) {
  Model& model = *world.models[slot];
  Robot robot;
  robot.name = model.name;
  robot.id = idIn(model.name);
  robot.model = slot;
  checkPose(model);
  configure(world, *model.description, &robot);
  weighRobot(*model.description, &robot);
  setTyres(*model.description, &robot);
  Pose centre;
  const Shape geometry = measure(*model.description, &robot, &centre);
  model.geometries.push_back({-1, centre, geometry, -1});
  const double yaw = model.pose.Rot().Yaw();
  const bool jointed = robot.drive.drive == Drive::kJointed;
  setRays(world, &robot);
  world.top_speed = std::max(world.top_speed, robot.drive.speed);
  model.index = world.fleet.add(std::move(robot), model.pose.X(), model.pose.Y(), yaw);
  updateFootprints(world, model);
  if (jointed) jointedBody(world, model.index);  // throws if it lacks a wheel
}

void removeRobot(WorldState& world, int robot) {
  if (world.fleet.unit[robot] >= 0) putDown(world, robot);
  for (StorageUnit& unit : world.units) {
    if (unit.claimed_by == robot) unit.claimed_by = -1;
  }
  const int last = world.fleet.size() - 1;
  world.fleet.remove(robot);
  world.obstacles.removeMover(robot);
  world.scans_due.clear();  // indices have changed
  if (robot != last) reindex(world, last, robot);
}

void placeRobot(WorldState& world, int robot, const EntityState& state) {
  Fleet& fleet = world.fleet;
  stopCruise(fleet, robot);
  if (!fleet.robots[robot].segments.empty()) {
    markBlocked(world, robot, "", "was moved by hand");
    endBlocked(world, robot);
  }
  fleet.x[robot] = state.pose.X();
  fleet.y[robot] = state.pose.Y();
  fleet.yaw[robot] = state.pose.Rot().Yaw();
  fleet.vx[robot] = state.twist.linear.X();
  fleet.vy[robot] = state.twist.linear.Y();
  fleet.yaw_rate[robot] = state.twist.angular.Z();
  fleet.awake[robot] = 1;
  fleet.look_again[robot] = 0;
  Model& model = world.modelOf(robot);
  if (model.in_physics) {
    deactivate(world, model);
    activate(world, model);
  }
  updateFootprints(world, model);
}

void resetRobot(WorldState& world, int robot) {
  Fleet& fleet = world.fleet;
  if (fleet.unit[robot] >= 0) putDown(world, robot);
  fleet.tower[robot] = 0;
  fleet.stance[robot] = Stance();
  placeRobot(world, robot, {world.modelOf(robot).spawn_pose, {}});
  for (int wheel = 0; wheel < 2; ++wheel) {
    fleet.wheel_speed[wheel][robot] = fleet.wheel_angle[wheel][robot] = 0;
  }
  updateFootprints(world, world.modelOf(robot));
}

Pose robotLinkPose(const WorldState& world, int robot, int link) {
  const Fleet& fleet = world.fleet;
  const Link& description = world.modelOf(robot).description->links[link];
  const Pose pose = basePose(world, robot) * description.pose_in_model;
  if (description.name == "tower") {
    return Pose(0, 0, fleet.tower[robot], 0, 0, 0) * pose;
  }
  for (int wheel = 0; wheel < 2; ++wheel) {
    if (description.name != (wheel == 0 ? "left_wheel" : "right_wheel")) continue;
    const double angle = wrapAngle(fleet.wheel_angle[wheel][robot]);
    // The axle is the chassis' y axis, however the wheel's own frame is turned.
    const Vector3 axle = description.pose_in_model.Rot().RotateVectorReverse(Vector3::UnitY);
    return pose * Pose(Vector3::Zero, Quaternion(axle, angle));
  }
  return pose;
}

}  // namespace kiva
