// SPDX-License-Identifier: Apache-2.0
#include "core/control/steering.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/control/grid.h"
#include "core/control/route.h"
#include "core/geometry/angle.h"
#include "core/motion/driving/dead_reckoning.h"
#include "core/motion/driving/self_location.h"
#include "core/motion/wheels/vehicle.h"
#include "core/state/progress/tasks.h"

namespace kiva {
namespace {

constexpr double kBackwards = 0.3;  // [m/s]: no laser looks back
// Where it may go back to the grid: its next command first drives it onto its point.
constexpr double kOffPoint = 0.05;         // [m]; as far as the camera sees the point's code
constexpr double kAskew = 5 * M_PI / 180;  // [rad]
constexpr double kStands = 1e-3;           // [m/s, rad/s]
constexpr double kDegree = M_PI / 180;     // [rad]

void checkHasNothingToDo(const FleetState& f, int robot) {
  const Task& task = f.tasks[robot];
  if (task.isSteered()) throw Refusal("it takes velocities already");
  if (task.phase == Phase::kIdle) return;
  throw Refusal(
      "it carries out a command: wait for its end, or end it by /cancel; a robot that a "
      "coordinator drives needs mode 1 (MANUAL) first");
}

double turnRateOf(const DriveParameters& drive) {
  return drive.quarter_turn_time > 0 ? M_PI / drive.quarter_turn_time : kUnlimited;
}

DriveVelocity within(const DriveParameters& drive, const DriveVelocity& asked) {
  const double turn_rate = turnRateOf(drive);
  return {std::clamp(asked.speed, -std::min(kBackwards, drive.speed), drive.speed),
          std::clamp(asked.turn_rate, -turn_rate, turn_rate)};
}

/// Warns, once a robot, that it is asked for more than it can do.
void warnOfLimits(TaskView& world, int robot) {
  const Robot& r = world.fleet.robots[robot];
  world.log.warn(r.name + " is asked for too much",
                 format("/%s/cmd_vel asks for more than it can do; it drives at most %g m/s ahead, "
                        "%g m/s back and turns at most at %.3g rad/s",
                        r.name.c_str(), r.drive.speed, std::min(kBackwards, r.drive.speed),
                        turnRateOf(r.drive)));
}

void checkStands(const FleetState& f, int robot) {
  const double speed = std::hypot(f.vx[robot], f.vy[robot]);
  if (speed < kStands && std::abs(f.yaw_rate[robot]) < kStands) return;
  throw Refusal(format("it drives at %.2f m/s: ask it to stop first", speed));
}

/// Throws Refusal, with the way to the next place where it may go back to the grid.
void checkOnGrid(const Scene& world, int robot) {
  const FleetState& f = world.fleet;
  const Point at{nearestGrid(world.settings, f.x[robot]), nearestGrid(world.settings, f.y[robot])};
  const double off = std::hypot(f.x[robot] - at.x, f.y[robot] - at.y);
  const double square = squareTo(f.yaw[robot]), askew = f.yaw[robot] - square;
  if (!isOnFloor(world, at)) throw Refusal("it stands where no cell of the floor is");
  if (off <= kOffPoint && std::abs(askew) <= kAskew) return;
  throw Refusal(
      format("it stands %.2f m off the grid point (%g, %g) and %.0f° off the heading of "
             "%.0f°: drive it to less than %g m and %.0f° first",
             off, at.x, at.y, std::abs(askew) / kDegree, wrapAngle(square) / kDegree, kOffPoint,
             kAskew / kDegree));
}

}  // namespace

void beginSteering(TaskView& world, int robot) {
  FleetState& f = world.fleet;
  checkMotion(f, robot);
  if (!f.robots[robot].has_rotation) throw Refusal("it has no rotation plugin");
  checkHasNothingToDo(f, robot);
  Steering steering;
  steering.kiva_id = f.robots[robot].id;
  f.steerings.push_back(steering);
  f.tasks[robot].command = 0;
  f.path_id[robot] = f.reached[robot] = f.left[robot] = 0;
  beginOdometry(world, robot);
  enterPhase(world, robot, Phase::kSteered, Status::kBusy, State::kSteered);
}

void endSteering(TaskView& world, int robot) {
  FleetState& f = world.fleet;
  if (!f.tasks[robot].isSteered()) throw Refusal("it takes no velocities");
  checkStands(f, robot);
  checkOnGrid(world, robot);
  const int id = f.robots[robot].id;
  f.steerings.erase(std::remove_if(f.steerings.begin(), f.steerings.end(),
                                   [id](const Steering& s) { return s.kiva_id == id; }),
                    f.steerings.end());
  f.wheel_target[0][robot] = f.wheel_target[1][robot] = 0;
  if (f.localises) relocate(world, robot);  // it reads the code on which it stands
  enterPhase(world, robot, Phase::kIdle, Status::kIdle, State::kIdle);
}

void steer(TaskView& world, int robot, const DriveVelocity& asked) {
  FleetState& f = world.fleet;
  if (!f.tasks[robot].isSteered()) throw Refusal("it takes no velocities");
  if (!std::isfinite(asked.speed) || !std::isfinite(asked.turn_rate)) {
    throw Refusal(format("a velocity of %g m/s and %g rad/s: finite numbers were expected",
                         asked.speed, asked.turn_rate));
  }
  if (f.failures[robot] & bitOf(Failure::kRadio)) return;  // it hears nothing
  const DriveVelocity held = within(f.robots[robot].drive, asked);
  if (held.speed != asked.speed || held.turn_rate != asked.turn_rate) warnOfLimits(world, robot);
  Steering& s = f.steering(robot);
  s.asked = held;
  s.silence = 0;
  s.looks = true;
  f.awake[robot] = 1;
}

}  // namespace kiva
