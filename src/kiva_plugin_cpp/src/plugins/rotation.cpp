// SPDX-License-Identifier: Apache-2.0
#include "rotation.h"

#include <algorithm>
#include <cmath>

#include "../core/commands.h"
#include "../core/cruise.h"
#include "../core/traction.h"
#include "motion.h"

namespace kiva {
namespace {

constexpr double kGain = 20;      // [1/s] yaw rate for angle lagged
constexpr double kStuck = 0.3;    // [rad] behind the profile
constexpr double kOverdue = 2.0;  // [s]
constexpr double kReserve = 0.9;  // of the possible acceleration, so that errors can be mended

/// From rest to rest over 90° in a time T: half of it at 4·90°/T², half at minus that, as far as
/// motors and floor can. 0 = at once, where they are without limit.
double turnAcceleration(const Robot& robot, double gravity) {
  const double time = robot.drive.quarter_turn_time;  // [s]; 0 asks for an infinite one
  const double acceleration =
      std::min(2 * M_PI / (time * time), kReserve * turningLimit(robot, gravity));
  return std::isinf(acceleration) ? 0 : acceleration;
}

double turnSpeed(const Robot& robot, double dt) {
  const double time = robot.drive.quarter_turn_time;
  return time == 0 ? 2 * M_PI / dt : M_PI / time;
}

void turnLeg(Parts& parts, int i) {
  Fleet& f = parts.fleet;
  Robot& r = f.robots[i];
  if (halting(parts, i)) return;
  if (!r.leg_started) {
    r.leg_started = true;
    f.setProfile(i, {f.yaw[i], f.yaw_rate[i]});
    f.goal[i] = r.legs.front().yaw;
    f.deceleration[i] = turnAcceleration(r, parts.gravityDown());
    r.overdue = 0;
  }
  const double lag = f.reference[i] - f.yaw[i];
  const bool ended = f.reference[i] == f.goal[i];
  if (ended && std::abs(lag) < kThereAngle && stands(f, i)) {
    setWheels(f, i, 0, 0);
    return finishLeg(parts, i);
  }
  if (ended) r.overdue += parts.dt;
  if (std::abs(lag) > kStuck || r.overdue > kOverdue) {
    return haltRobot(parts, i, "", "is stuck: it can't turn");
  }
  const double top = turnSpeed(r, parts.dt), acceleration = f.deceleration[i];
  if (isExact(lag) && tryCruise(parts, i, {0, 0, 1, top, acceleration})) return;
  Profile profile = f.profile(i);
  profile.advance(f.goal[i], top, acceleration, acceleration, parts.dt);
  f.setProfile(i, profile);
  setWheels(f, i, 0, profile.speed + kGain * lag);
}

}  // namespace

void RotationPlugin::configure(Robot& robot, const Parameters& p) const {
  robot.drive.quarter_turn_time = p.number("quarter_turn_time", 0.625, 0, 1000);
  robot.has_rotation = true;
}

void RotationPlugin::beforeStep(Parts& parts) {
  const Fleet& f = parts.fleet;
  for (int i : parts.active) {
    if (f.robots[i].legs.empty()) continue;
    if (f.robots[i].legs.front().kind == Leg::Kind::kTurn) turnLeg(parts, i);
  }
}

}  // namespace kiva
