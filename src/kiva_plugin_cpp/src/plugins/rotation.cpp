// SPDX-License-Identifier: Apache-2.0
#include "rotation.h"

#include <algorithm>
#include <cmath>

#include "../core/commands.h"
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
    r.profile = {f.yaw[i], f.yaw_rate[i]};
    r.goal = r.legs.front().yaw;
    r.deceleration = turnAcceleration(r, parts.gravityDown());
    r.overdue = 0;
  }
  const double lag = r.profile.position - f.yaw[i];
  const bool ended = r.profile.reached(r.goal);
  if (ended && std::abs(lag) < tolerance(r).angle && stands(f, i)) {
    setWheels(f, i, 0, 0);
    return finishLeg(parts, i);
  }
  if (ended) r.overdue += parts.dt;
  if (std::abs(lag) > kStuck || r.overdue > kOverdue) {
    return haltRobot(parts, i, "", "is stuck: it can't turn");
  }
  r.profile.advance(r.goal, turnSpeed(r, parts.dt), r.deceleration, r.deceleration, parts.dt);
  setWheels(f, i, 0, r.profile.speed + kGain * lag);
}

}  // namespace

void RotationPlugin::configure(Robot& robot, const Parameters& p) const {
  robot.drive.quarter_turn_time = p.number("quarter_turn_time", 0.625, 0, 1000);
  robot.has_rotation = true;
}

void RotationPlugin::beforeStep(Parts& parts) {
  const Fleet& f = parts.fleet;
  for (int i = 0; i < f.size(); ++i) {
    if (!f.awake[i] || f.robots[i].legs.empty()) continue;
    if (f.robots[i].legs.front().kind == Leg::Kind::kTurn) turnLeg(parts, i);
  }
}

}  // namespace kiva
