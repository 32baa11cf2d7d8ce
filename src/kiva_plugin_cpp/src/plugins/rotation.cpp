// SPDX-License-Identifier: Apache-2.0
#include "plugins/rotation.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/motion/driving/cruise.h"
#include "core/motion/driving/drives.h"
#include "core/motion/driving/self_location.h"
#include "core/motion/driving/stretches.h"
#include "core/motion/wheels/ground.h"
#include "core/sensing/room.h"
#include "core/state/progress/tasks.h"
#include "plugins/motion.h"

namespace kiva {
namespace {

constexpr double kGain = 20;         // yaw rate per angle of lag [1/s]
constexpr double kStuckAngle = 0.3;  // lag behind the profile of a robot that is stuck [rad]
constexpr double kSpins = 0.2;       // difference of profile and gyro that proves slip [rad/s]
constexpr double kLeast = 0.1;       // smallest acceleration, where nothing grips [rad/s²]
constexpr double kReserve = 0.9;     // share of the motors' torque, the rest corrects errors

/// Stops a turn with its final deceleration, and stays.
void holdTurn(RobotView& world, int i) {
  FleetState& f = world.fleet;
  if (f.tasks[i].phase == Phase::kStarting) return setWheels(f, i, 0, 0);
  const double lag = f.reference[i] - f.believed(i).yaw;
  Profile command = f.command(i);
  if (command.speed != 0) command.brake(f.deceleration[i], world.clock.dt, &f.tasks[i].stop_at);
  f.follow(i, command);
  if (f.reference_speed[i] == 0 && std::abs(lag) < kThereAngle && stands(f, i)) {
    return setWheels(f, i, 0, 0);
  }
  setWheels(f, i, 0, f.reference_speed[i] + kGain * lag);
}

/// Halves the acceleration of a turn where the gyro shows that wheels spin, before odometry is
/// misled. Only floors with slippery places need it.
void feelGrip(RobotView& world, int i) {
  FleetState& f = world.fleet;
  const bool spins = std::abs(f.reference_speed[i] - f.yaw_rate[i]) > kSpins;
  if (!spins || f.deceleration[i] == 0 || !isPatchy(world)) return;
  f.deceleration[i] = std::max(kLeast, f.deceleration[i] / 2);
  f.setProfile(i, {f.believed(i).yaw, f.yaw_rate[i]});
}

/// Ends a turn before it begins if it would hit the legs of a storage unit that stands askew.
/// Returns whether there is room.
bool hasRoom(TaskView& world, int i) {
  const FleetState& f = world.fleet;
  const double goal = f.yaw[i] + f.tasks[i].segments.front().yaw - f.believed(i).yaw;
  const TurnRoom room = roomToTurn(world, i, {f.x[i], f.y[i], f.yaw[i]}, Among::kUnits);
  if (room.holds(goal)) return true;
  const std::string& unit = world.models[goal > room.most ? room.at_most : room.at_least]->name;
  haltRobot(world, i, unit, unit + " leaves no room to turn");
  return false;
}

void turnSegment(TaskView& world, Obstacles& obstacles, int i) {
  FleetState& f = world.fleet;
  Task& task = f.tasks[i];
  const Robot& r = f.robots[i];
  if (halting(world, i)) return;
  if (isHeld(f, i)) return holdTurn(world, i);
  if (task.phase == Phase::kStarting) {
    if (!hasRoom(world, i)) return;
    if (f.localises) readCode(world, i, true);
    task.phase = Phase::kTurning;
    const double yaw = f.believed(i).yaw;
    f.setProfile(i, {yaw, f.yaw_rate[i]});
    f.reference_end[i] = task.segments.front().yaw;
    f.deceleration[i] = turnAcceleration(world, i, std::abs(f.reference_end[i] - yaw));
  }
  feelGrip(world, i);
  const double lag = f.reference[i] - f.believed(i).yaw;
  const bool ended = f.reference[i] == f.reference_end[i];
  if (ended && std::abs(lag) < kThereAngle && stands(f, i)) {
    setWheels(f, i, 0, 0);
    return finishSegment(world, i);
  }
  if (ended) task.overdue += world.clock.dt;
  if (std::abs(lag) > kStuckAngle || task.overdue > kOverdue) {
    return haltRobot(world, i, "", "is stuck: it can't turn");
  }
  const double top = turnSpeed(r, world.clock.dt), acceleration = f.deceleration[i];
  const bool exact = f.localises ? isOnCourse(lag, 0, 0) : isExact(lag);
  if (exact && tryCruise(world, obstacles, i, {0, 0, 1, top, acceleration})) return;
  Profile command = f.command(i);
  command.advance(f.reference_end[i], top, acceleration, acceleration, world.clock.dt);
  f.follow(i, command);
  setWheels(f, i, 0, f.reference_speed[i] + kGain * lag);
}

}  // namespace

// A turn by 90° from rest to rest takes T: 4·90°/T² in its first half, minus that in its second.
// T = 0: at once, where motors and floor have no limit.
double turnAcceleration(const Scene& world, int i, double angle) {
  const double time =
      world.fleet.robots[i].drive.quarter_turn_time;  // [s]; 0 asks for an infinite one
  Vehicle vehicle = plannedVehicle(world, i);
  vehicle.torque *= kReserve;
  const double acceleration = std::min(2 * M_PI / (time * time), turningLimit(vehicle, angle));
  return std::isinf(acceleration) ? 0 : acceleration;
}

double turnSpeed(const Robot& robot, double dt) {
  const double time = robot.drive.quarter_turn_time;
  return time == 0 ? 2 * M_PI / dt : M_PI / time;
}

void RotationPlugin::configure(Robot& robot, const Parameters& p) const {
  robot.drive.rotationFields(robot.drive, p.reader());
  robot.has_rotation = true;
}

void RotationPlugin::control(ContactView& world) const {
  for (int i : world.schedule.stepped_singly) {
    if (world.fleet.tasks[i].isAt(MotionSegment::Kind::kTurn))
      turnSegment(world, world.obstacles, i);
  }
}

}  // namespace kiva
