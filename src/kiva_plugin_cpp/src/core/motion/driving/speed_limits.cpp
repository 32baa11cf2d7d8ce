// SPDX-License-Identifier: Apache-2.0
#include "core/motion/driving/speed_limits.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/motion/driving/drives.h"
#include "core/state/progress/path_progress.h"

namespace kiva {
namespace {

constexpr double kAnySpeed = std::numeric_limits<double>::infinity();
constexpr double kTimeConstants = 5;  // time constants until lagging motors have come to a limit

bool hasLimits(const Task& task) { return task.path.isLimited() && task.isOnRun(); }

/// Returns the point to which the robot drives, by its reference.
std::uint32_t presentWay(const FleetState& f, int i) {
  const Task& task = f.tasks[i];
  const std::uint32_t first = task.path.origin + 1;
  // Points count as reached a little before the robot is there.
  std::uint32_t k = std::max(first, f.reached[i] > 0 ? f.reached[i] - 1 : 0);
  while (k < task.path.end && f.reference[i] >= alongRun(task, k)) ++k;
  return std::min(k, std::max(first, task.path.end));
}

/// Returns the distance in which steps of constant deceleration end a speed [m].
double stoppingWay(double speed, double deceleration, double dt) {
  return deceleration > 0 ? speed * speed / (2 * deceleration) + speed * dt / 2 : 0;
}

/// Returns the distance before a slower way at which its limit is kept already [m].
double marginOf(const FleetState& f, int i, double limit, double dt) {
  // Wheels follow the reference a step later: without acceleration that is a step at full speed.
  const double before =
      f.acceleration[i] > 0 ? limit + f.acceleration[i] * dt : limit + f.robots[i].drive.speed;
  const double step = before * dt;
  return f.lag.isNone() ? step : step + kTimeConstants * f.lag.behind * limit;
}

}  // namespace

double permittedSpeed(const Scene& world, int i) {
  const FleetState& f = world.fleet;
  const Task& task = f.tasks[i];
  if (!hasLimits(task)) return kAnySpeed;
  const double dt = world.clock.dt, braking = f.acceleration[i];
  const Profile command = f.command(i);
  const double speed = std::abs(command.speed);
  std::uint32_t k = presentWay(f, i);
  double permitted = task.path.limitTo(k);
  for (; k < task.path.end; ++k) {
    const double limit = task.path.limitTo(k + 1);
    if (limit >= permitted) continue;
    const double way = alongRun(task, k) - command.position - marginOf(f, i, limit, dt);
    if (way > stoppingWay(f.robots[i].drive.speed, braking, dt) + speed * dt) break;
    const double room = std::max(0.0, way) + stoppingWay(limit, braking, dt);
    permitted =
        std::min(permitted, braking > 0 ? Profile::stoppingSpeed(room, braking, dt) : limit);
  }
  if (braking == 0) return permitted;
  return std::max(permitted, speed - plannedBraking(world, i) * dt);
}

double holdsUntil(const Scene& world, int i, double top_speed) {
  const FleetState& f = world.fleet;
  const Task& task = f.tasks[i];
  double until = kAnySpeed;
  if (!hasLimits(task)) return until;
  const double dt = world.clock.dt, fast = stoppingWay(top_speed, f.acceleration[i], dt);
  for (std::uint32_t k = presentWay(f, i); k < task.path.end; ++k) {
    const double limit = task.path.limitTo(k + 1), begin = alongRun(task, k);
    if (begin - fast > until) break;
    if (limit > task.path.limitTo(k)) until = std::min(until, begin);
    if (limit >= top_speed) continue;
    const double slow = stoppingWay(limit, f.acceleration[i], dt);
    const double lagging = f.lag.behind * top_speed;
    until = std::min(until, begin - (fast - slow) - marginOf(f, i, limit, dt) - lagging);
  }
  return until;
}

bool holdsSpeed(const Scene& world, int i, double top_speed) {
  if (!world.fleet.tasks[i].path.isLimited()) return true;
  const double next = world.fleet.reference[i] + 2 * top_speed * world.clock.dt;
  return next < holdsUntil(world, i, top_speed);
}

}  // namespace kiva
