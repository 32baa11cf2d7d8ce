// SPDX-License-Identifier: Apache-2.0
#include "core/models/robots.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/contact/activation.h"
#include "core/geometry/angle.h"
#include "core/models/load.h"
#include "core/motion/driving/dead_reckoning.h"
#include "core/motion/driving/drives.h"
#include "core/motion/driving/self_location.h"
#include "core/motion/joints/jointed_body.h"
#include "core/motion/wheels/ground.h"
#include "core/physics/bodies/spatial_inertia.h"
#include "core/sensing/scans.h"
#include "core/state/places/footprints.h"
#include "core/state/places/poses.h"
#include "core/state/progress/tasks.h"
#include "core/state/views/fleet_plugin.h"
#include "core/state/world/random_stream.h"

namespace kiva {
namespace {

constexpr char kMotionPlugin[] = "libkiva_motion.so";
constexpr double kUprightAngle = 1e-3;  // [rad]
constexpr double kNearFloor = 1.0;  // [m] above the floor up to which a spawned robot is put on it

int idIn(const std::string& name) {
  const int id = numberIn(name, "kiva");
  if (id >= 1 && id <= kMaxKivaId) return id;
  throw DescriptionError("model '" + name + "': a robot is called kiva<id> with an id from 1 to " +
                         std::to_string(kMaxKivaId));
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
  if (box.empty()) {
    throw DescriptionError("model '" + robot->name + "': a robot needs a collision shape");
  }
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

/// Returns the realism in the parameters of a motion plugin, if there is any.
std::optional<Realism> realismOf(const Parameters& parameters) {
  const auto below = parameters.values().lower_bound("realism");
  if (below == parameters.values().end() || below->first.rfind("realism", 0) != 0) {
    return std::nullopt;
  }
  parameters.text("realism", "");  // blanks around its sections
  return readRealism(parameters, "realism/");
}

/// Throws DescriptionError if the world has another realism already.
void checkRealism(const Scene& world, const Parameters& parameters) {
  const std::optional<Realism> asked = realismOf(parameters);
  if (!asked || world.settings.options.realism || !world.settings.realism_of_models) return;
  if (*asked == world.settings.realism) return;
  throw DescriptionError(parameters.where() +
                         ": <realism> is not that of the robots before; all robots of a world have "
                         "the same");
}

/// Adopts the realism of the first robot whose file has one, unless the world's options do.
void adoptRealism(const Scene& world, FleetState& fleet, WorldSettings& settings,
                  const ModelDescription& description) {
  if (settings.options.realism || settings.realism_of_models) return;
  for (const PluginDescription& plugin : description.plugins) {
    if (plugin.filename != kMotionPlugin) continue;
    const std::optional<Realism> asked = realismOf(plugin.parameters);
    if (!asked) continue;
    settings.realism = *asked;
    settings.realism_of_models = true;
    fleet.applyRealism(settings.realism, world.clock.dt);
  }
}

void configure(const Scene& world, const ModelDescription& description, Robot* robot) {
  for (const PluginDescription& plugin : description.plugins) {
    const FleetPlugin* ours = findFleetPlugin(world.plugins, plugin.filename);
    if (!ours) continue;
    ours->configure(*robot, plugin.parameters);
    if (plugin.filename == kMotionPlugin) checkRealism(world, plugin.parameters);
    plugin.parameters.rejectUnread();
  }
  if (world.settings.options.drive) robot->drive.drive = *world.settings.options.drive;
}

/// Updates all that is stored by a robot's index after a change of that index.
void reindexRobot(MotionView& world, int from, int to) {
  Model& model = world.models.of(world.fleet.robots[to]);
  model.index = to;
  for (StorageUnit& unit : world.storage.units) {
    if (unit.carrier == from) unit.carrier = to;
    if (unit.claimed_by == from) unit.claimed_by = to;
  }
  moved(world, model);
}

void weigh(const ModelDescription& description, Robot* robot) {
  SpatialInertia whole;
  for (const Link& link : description.links) whole.add(link, link.pose_in_model);
  robot->mass = whole.mass();
  robot->inertia = whole.aboutZ();
  robot->centre[0] = whole.centre().X();
  robot->centre[1] = whole.centre().Y();
}

/// Sets the tyres' friction, if the model has wheels.
void setTyres(const ModelDescription& description, Robot* robot) {
  const char* const wheels[] = {"left_wheel", "right_wheel"};
  for (int side = 0; side < 2; ++side) {
    const Link* wheel = description.findLink(wheels[side]);
    if (wheel) robot->tyre_friction[side] = tyreFriction(*wheel);
  }
}

void stand(FleetState& f, int robot, const EntityState& at) {
  f.x[robot] = at.pose.X();
  f.y[robot] = at.pose.Y();
  f.yaw[robot] = at.pose.Rot().Yaw();
  f.vx[robot] = at.twist.linear.X();
  f.vy[robot] = at.twist.linear.Y();
  f.yaw_rate[robot] = at.twist.angular.Z();
}

/// Stops a steered robot that was put elsewhere. Its wheels have not turned.
void restartSteering(TaskView& world, int robot, const PlanarPose& counted) {
  Steering fresh;
  Steering& steering = world.fleet.steering(robot);
  fresh.kiva_id = steering.kiva_id;
  steering = fresh;
  for (auto& target : world.fleet.wheel_target) target[robot] = 0;
  keepOdometry(world, robot, counted);
  setStatus(world, robot, Status::kBusy, State::kSteered);
}

/// Sets the motion that was measured, as far as it was.
void setMotion(const WorldSettings& settings, Robot* robot) {
  const MotionRealism& real = settings.realism.motion;
  const auto set = [](double measured, double* value) {
    if (measured > 0) *value = measured;
  };
  if (!real.enabled) return;
  set(real.speed, &robot->drive.speed);
  set(real.acceleration, &robot->drive.acceleration);
  set(real.quarter_turn_time, &robot->drive.quarter_turn_time);
  set(real.lift_time, &robot->lift.time);
}

/// Varies motors and tyres a little from the values in the file, by which plans are made.
void setSpread(const WorldSettings& settings, Robot* robot) {
  constexpr double kMost = 3;  // limit in standard deviations
  const ActuationRealism& real = settings.realism.actuation;
  if (!real.enabled) return;
  RandomStream random(settings.options.seed, Matter::kActuation, robot->id, 0);
  const auto deviate = [&](double share) {
    return 1 + share * std::clamp(random.normal(), -kMost, kMost);
  };
  robot->drive.motor_torque *= deviate(real.torque_spread);
  for (double& friction : robot->tyre_friction) friction *= deviate(real.friction_spread);
}

}  // namespace

bool isRobot(const ModelDescription& description) {
  return std::any_of(description.plugins.begin(), description.plugins.end(),
                     [](const PluginDescription& p) { return p.filename == kMotionPlugin; });
}

void Robots::add(ModelView& world, Model& model) const {
  Robot robot;
  robot.name = model.name;
  robot.id = idIn(model.name);
  robot.model = model.slot;
  checkPose(model);
  configure(world, *model.description, &robot);
  weigh(*model.description, &robot);
  setTyres(*model.description, &robot);
  Pose centre;
  const Shape box = measure(*model.description, &robot, &centre);
  model.geometries.push_back({-1, centre, box, -1});
  const double yaw = model.pose.Rot().Yaw();
  const bool jointed = robot.drive.drive == Drive::kJointed;
  adoptRealism(world, world.fleet, world.settings, *model.description);
  setMotion(world.settings, &robot);
  setRays(world.scans, &robot);
  world.fleet.fastest = std::max(world.fleet.fastest, robot.drive.speed);
  world.floor.cover_due = true;
  setSpread(world.settings, &robot);
  model.index = world.fleet.add(std::move(robot), model.pose.X(), model.pose.Y(), yaw);
  if (world.fleet.localises) calibrate(world, model.index);
  moved(world, model);
  if (jointed) jointedBody(world, model.index);  // throws if a wheel is missing
}

void Robots::remove(ModelView& world, Model& model) const {
  const int robot = model.index, last = world.fleet.size() - 1;
  if (robot < 0) return;  // it never joined the fleet
  if (world.fleet.unit[robot] >= 0) putDown(world, robot);
  for (StorageUnit& unit : world.storage.units) {
    if (unit.claimed_by == robot) unit.claimed_by = -1;
  }
  auto& defects = world.failures.defects;
  const int id = world.fleet.robots[robot].id;
  defects.erase(std::remove_if(defects.begin(), defects.end(),
                               [id](const Defect& defect) { return defect.kiva_id == id; }),
                defects.end());
  world.fleet.remove(robot);
  world.obstacles.removeMover(robot);
  world.scans.due.clear();  // indices have changed
  world.scans.sighted.clear();
  if (robot != last) reindexRobot(world, last, robot);
}

void Robots::place(ModelView& world, Model& model, const EntityState& state) const {
  const int robot = model.index;
  const bool is_steered = world.fleet.tasks[robot].isSteered();
  const PlanarPose counted = is_steered ? countedPose(world.fleet, robot) : PlanarPose();
  if (!is_steered && world.fleet.tasks[robot].phase != Phase::kIdle) {
    endBlocked(world, robot, "", "was moved by hand");
  }
  moved(world.fleet, robot);
  stand(world.fleet, robot, state);
  if (world.fleet.localises) relocate(world, robot);
  if (is_steered) restartSteering(world, robot, counted);
  rebuildBody(world, model);
}

void Robots::reset(ModelView& world, Model& model) const {
  FleetState& fleet = world.fleet;
  const int robot = model.index;
  if (fleet.unit[robot] >= 0) putDown(world, robot);
  fleet.tower[robot] = 0;
  fleet.stance[robot] = Stance();
  fleet.stopped[robot] = 0;
  fleet.failures[robot] = 0;
  fleet.battery[robot] = Battery();
  fleet.charge[robot] = 1;
  fleet.robots[robot].grip = 1;
  place(world, model, {model.spawn_pose, {}});
  fleet.path_id[robot] = fleet.reached[robot] = fleet.left[robot] = 0;
  for (int wheel = 0; wheel < 2; ++wheel) {
    fleet.wheel_speed[wheel][robot] = fleet.wheel_angle[wheel][robot] = 0;
  }
  if (fleet.localises) relocate(world, robot);  // its wheels are at 0 now
  if (fleet.tasks[robot].isSteered()) beginOdometry(world, robot);
}

EntityState Robots::state(const Scene& world, const Model& model) const {
  return robotState(world, model.index);
}

/// Returns a link's pose, with wheels turned and tower raised.
Pose Robots::linkPose(const Scene& world, const Model& model, int link) const {
  const Fleet& fleet = world.fleet;
  const int robot = model.index;
  const Link& description = model.description->links[link];
  const Pose pose = basePose(world, robot) * description.pose_in_model;
  if (description.name == "tower") {
    return Pose(0, 0, fleet.tower[robot], 0, 0, 0) * pose;
  }
  for (int wheel = 0; wheel < 2; ++wheel) {
    if (description.name != (wheel == 0 ? "left_wheel" : "right_wheel")) continue;
    const double angle = wrapAngle(fleet.wheel_angle[wheel][robot]);
    // The axle is the chassis' y axis, whatever the wheel's own frame.
    const Vector3 axle = description.pose_in_model.Rot().RotateVectorReverse(Vector3::UnitY);
    return pose * Pose(Vector3::Zero, Quaternion(axle, angle));
  }
  return pose;
}

void Robots::reweigh(ContactView& world, Model& model, double /*added*/) const {
  moved(world.fleet, model.index);
  weigh(*model.description, &world.fleet.robots[model.index]);
  rebuildBody(world, model);
}

/// Pushes the robot; the grip of its wheels counteracts in the same step.
bool Robots::push(ContactView& world, Model& model, int /*link*/, const Vector3& at,
                  const Vector3& force, const Vector3& torque) const {
  FleetState& f = world.fleet;
  const int i = model.index;
  const Vehicle vehicle = vehicleOf(f.robots[i], groundOf(world));
  const Vector3 centre = centreFromOrigin(f, i);
  const Vector3 arm = at - basePose(world, i).Pos() - centre;
  const double turn = (torque + arm.Cross(force)).Z() / vehicle.inertia * world.clock.dt;
  moved(f, i);
  f.vx[i] += force.X() / vehicle.mass * world.clock.dt + turn * centre.Y();
  f.vy[i] += force.Y() / vehicle.mass * world.clock.dt - turn * centre.X();
  f.yaw_rate[i] += turn;
  return true;
}

ModelBodies Robots::build(const Scene& world, const Model& model) const {
  const int robot = model.index;
  const Robot& r = world.fleet.robots[robot];
  Link link;
  const Vehicle vehicle = vehicleOf(r, groundOf(world));
  link.mass = vehicle.mass;
  link.principal_moments.Set(vehicle.inertia, vehicle.inertia, vehicle.inertia);
  link.inertial_pose_in_link.Pos().Set(vehicle.centre[0], vehicle.centre[1], 0);
  link.gravity = false;
  ModelDescription planar;
  planar.links.push_back(link);
  ModelBodies bodies =
      world.physics.build(planar, basePose(world, robot), model.slot, kRobotGroup, ~kFloorGroup);
  LinkBody& body = bodies.links.front();
  const btTransform base = (toBullet(basePose(world, robot)) * body.mass_frame).inverse();
  const auto add = [&](const Model& part) {
    for (std::size_t i = 0; i < part.description->links.size(); ++i) {
      const btTransform at = base * toBullet(kiva::linkPose(world, part, static_cast<int>(i)));
      for (const Collision& collision : part.description->links[i].collisions) {
        body.shape.add(collision, at * toBullet(collision.pose_in_link), part.slot);
      }
    }
  };
  add(model);
  const int unit = world.fleet.unit[robot];
  if (unit >= 0) add(*world.models[world.storage.units[unit].model]);
  body.body->setLinearFactor({1, 1, 0});
  body.body->setAngularFactor({0, 0, 1});
  body.body->setActivationState(DISABLE_DEACTIVATION);
  return bodies;
}

void Robots::activated(RobotView& world, Model& model) const {
  world.fleet.activated[model.index] = 1;
  moved(world.fleet, model.index);
}

void Robots::deactivated(RobotView& world, Model& model) const {
  world.fleet.activated[model.index] = 0;
}

}  // namespace kiva
