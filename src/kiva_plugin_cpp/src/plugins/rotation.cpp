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

constexpr double kGain = 20;         // [1/s] yaw rate for angle lagged
constexpr double kStuckAngle = 0.3;  // [rad] behind the profile
constexpr double kSpins = 0.2;       // [rad/s] between a profile and the gyro
constexpr double kLeast = 0.1;       // [rad/s²] that it turns with where nothing grips
constexpr double kReserve = 0.9;     // of the motors' torque, so that errors can be mended

/// From rest to rest over 90° in a time T: half of it at 4·90°/T², half at minus that, as far as
/// motors and floor can. 0 = at once, where they are without limit.
double turnAcceleration(MotionView& world, int i, double angle) {
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

/// Stops turning as hard as it would at the turn's end, and stays so.
void holdTurn(MotionView& world, int i) {
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

/// On a floor that is slippery in places a gyro tells that wheels spin, before odometry is misled:
/// from there on it turns half as hard.
void feelGrip(MotionView& world, int i) {
  FleetState& f = world.fleet;
  const bool spins = std::abs(f.reference_speed[i] - f.yaw_rate[i]) > kSpins;
  if (!spins || f.deceleration[i] == 0 || !isPatchy(world)) return;
  f.deceleration[i] = std::max(kLeast, f.deceleration[i] / 2);
  f.setProfile(i, {f.believed(i).yaw, f.yaw_rate[i]});
}

/// Ends a turn that would tear at the legs of a storage unit that stands askew, before it begins.
bool hasRoom(MotionView& world, int i) {
  const FleetState& f = world.fleet;
  const double goal = f.yaw[i] + f.tasks[i].segments.front().yaw - f.believed(i).yaw;
  const TurnRoom room = roomToTurn(world, i, {f.x[i], f.y[i], f.yaw[i]}, Among::kUnits);
  if (room.holds(goal)) return true;
  const std::string& unit = world.models[goal > room.most ? room.at_most : room.at_least]->name;
  haltRobot(world, i, unit, unit + " leaves no room to turn");
  return false;
}

void turnSegment(MotionView& world, int i) {
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
    f.goal[i] = task.segments.front().yaw;
    f.deceleration[i] = turnAcceleration(world, i, std::abs(f.goal[i] - yaw));
  }
  feelGrip(world, i);
  const double lag = f.reference[i] - f.believed(i).yaw;
  const bool ended = f.reference[i] == f.goal[i];
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
  if (exact && tryCruise(world, i, {0, 0, 1, top, acceleration})) return;
  Profile command = f.command(i);
  command.advance(f.goal[i], top, acceleration, acceleration, world.clock.dt);
  f.follow(i, command);
  setWheels(f, i, 0, f.reference_speed[i] + kGain * lag);
}

}  // namespace

void RotationPlugin::configure(Robot& robot, const Parameters& p) const {
  robot.drive.rotationFields(robot.drive, p.reader());
  robot.has_rotation = true;
}

void RotationPlugin::control(ContactView& world) const {
  for (int i : world.schedule.stepped_singly) {
    if (world.fleet.tasks[i].isAt(MotionSegment::Kind::kTurn)) turnSegment(world, i);
  }
}

}  // namespace kiva
