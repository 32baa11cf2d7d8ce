// SPDX-License-Identifier: Apache-2.0
#include "core/motion/cruise.h"

#include <algorithm>
#include <cmath>

#include "core/motion/clearance.h"
#include "core/motion/drives.h"

namespace kiva {
namespace {

constexpr double kHorizons[] = {0.3, 0.08};  // [s] for which the way may be found free
constexpr double kRetry = 0.05;  // [s] after which one looks again that had somebody near
constexpr double kMargin = 2;    // of force to spare: a profile's last steps are uneven

/// Whether the chassis is just as fast as its reference says.
bool keepsUp(const Fleet& f, int i, const Motion& per) {
  const double v = f.reference_speed[i];
  return isExact(f.vx[i] - per.x * v) && isExact(f.vy[i] - per.y * v) &&
         isExact(f.yaw_rate[i] - per.yaw * v);
}

bool hasForce(const Robot& robot, const Motion& per, double deceleration, const Ground& ground) {
  if (robot.drive.acceleration == 0) return true;  // grip and motors are without limit
  if (per.acceleration == 0) return false;
  const double hardest = kMargin * std::max(per.acceleration, deceleration);
  const Vehicle vehicle = vehicleOf(robot, ground);
  if (per.yaw == 0) return hardest < std::min(drivingLimit(vehicle), brakingLimit(vehicle));
  return std::max(turningEffort(vehicle, hardest, per.top_speed),
                  turningEffort(vehicle, -hardest, per.top_speed)) < 1;
}

/// What the robot covers of the floor while its reference goes on by `way`.
Footprint sweep(const Fleet& f, int i, double way) {
  if (f.per_yaw[i] != 0) return turned(footprintOf(f, i));
  return moved(footprintOf(f, i), f.per_x[i] * way, f.per_y[i] * way);
}

/// How far the reference goes at most in that time.
double wayWithin(const Fleet& f, int i, double time) {
  const double way = f.goal[i] - f.reference[i];
  const double most = f.top_speed[i] * time;
  return std::clamp(way, -most, most);
}

/// Looks ahead at step `now`; returns whether the robot may cruise on, for a while.
bool renew(WorldState& world, int i, double now) {
  Fleet& f = world.fleet;
  for (const double horizon : kHorizons) {
    const bool turns = f.per_yaw[i] != 0;
    const double time =
        turns ? horizon : std::min(horizon, Obstacles::kSlack / std::max(1e-9, f.top_speed[i]));
    const double way = wayWithin(f, i, time);
    if (!isClear(world, i, sweep(f, i, way), time)) continue;
    world.obstacles.follow(i, turns ? 0 : std::abs(way));
    f.cruise_until[i] = now + std::floor(time / world.dt);
    return true;
  }
  return false;
}

constexpr int kBlock = 16;  // robots that are stepped together

/// One step of robots [begin, end) that cruise. Returns whether one of them needs a look: its
/// reference has ended, or its time is over at step `now`.
__attribute__((target_clones("avx2", "default"))) bool advance(Fleet& f, int begin, int end,
                                                               double dt, double now) {
  const std::int64_t* __restrict mask = f.cruising.data();
  const double* __restrict goal = f.goal.data();
  const double* __restrict top = f.top_speed.data();
  const double* __restrict acceleration = f.acceleration.data();
  const double* __restrict deceleration = f.deceleration.data();
  const double* __restrict until = f.cruise_until.data();
  const double* __restrict per_x = f.per_x.data();
  const double* __restrict per_y = f.per_y.data();
  const double* __restrict per_yaw = f.per_yaw.data();
  const double* __restrict per_left = f.per_wheel[0].data();
  const double* __restrict per_right = f.per_wheel[1].data();
  double* __restrict reference = f.reference.data();
  double* __restrict speed = f.reference_speed.data();
  double* __restrict x = f.x.data();
  double* __restrict y = f.y.data();
  double* __restrict yaw = f.yaw.data();
  double* __restrict vx = f.vx.data();
  double* __restrict vy = f.vy.data();
  double* __restrict yaw_rate = f.yaw_rate.data();
  double* __restrict left = f.wheel_angle[0].data();
  double* __restrict right = f.wheel_angle[1].data();
  double* __restrict left_speed = f.wheel_speed[0].data();
  double* __restrict right_speed = f.wheel_speed[1].data();
  std::int64_t attention = 0;
#pragma GCC ivdep
  for (int i = begin; i < end; ++i) {
    const std::int64_t cruises = mask[i];
    const double was_reference = reference[i], was_speed = speed[i];
    const double was_vx = vx[i], was_vy = vy[i], was_yaw_rate = yaw_rate[i];
    const double was_left = left_speed[i], was_right = right_speed[i];
    Profile profile{was_reference, was_speed};
    profile.advance(goal[i], top[i], acceleration[i], deceleration[i], dt);
    const double v = profile.speed;
    const double way = cruises ? v * dt : 0.0;
    reference[i] = cruises ? profile.position : was_reference;
    speed[i] = cruises ? v : was_speed;
    x[i] += per_x[i] * way;
    y[i] += per_y[i] * way;
    yaw[i] += per_yaw[i] * way;
    left[i] += per_left[i] * way;
    right[i] += per_right[i] * way;
    vx[i] = cruises ? per_x[i] * v : was_vx;
    vy[i] = cruises ? per_y[i] * v : was_vy;
    yaw_rate[i] = cruises ? per_yaw[i] * v : was_yaw_rate;
    left_speed[i] = cruises ? per_left[i] * v : was_left;
    right_speed[i] = cruises ? per_right[i] * v : was_right;
    const std::int64_t ended = profile.position == goal[i] ? -1 : 0;
    const std::int64_t due = until[i] <= now ? -1 : 0;
    attention |= cruises & (ended | due);
  }
  return attention != 0;
}

double retryStep(const WorldState& world, double now) { return now + std::ceil(kRetry / world.dt); }

void attend(WorldState& world, int i, double now) {
  Fleet& f = world.fleet;
  if (f.reference[i] == f.goal[i]) return stopCruise(f, i);
  if (f.cruise_until[i] > now || renew(world, i, now)) return;
  stopCruise(f, i);
  f.cruise_until[i] = retryStep(world, now);
}

}  // namespace

bool tryCruise(WorldState& world, int i, const Motion& per) {
  Fleet& f = world.fleet;
  const Robot& r = f.robots[i];
  const auto now = static_cast<double>(world.total_steps);
  if (r.drive.drive == Drive::kJointed || f.activated[i] || world.options.always_in_bullet ||
      f.cruise_until[i] > now || f.reference[i] == f.goal[i] || (f.tower[i] > 0 && f.unit[i] < 0) ||
      std::abs(f.reference_speed[i]) > per.top_speed || !keepsUp(f, i, per) ||
      !hasForce(r, per, f.deceleration[i], groundOf(world))) {
    return false;
  }
  const double turn = per.yaw * r.drive.wheel_separation / 2;
  const double ahead = std::cos(f.yaw[i]) * per.x + std::sin(f.yaw[i]) * per.y;
  f.per_x[i] = per.x;
  f.per_y[i] = per.y;
  f.per_yaw[i] = per.yaw;
  f.per_wheel[0][i] = (ahead - turn) / r.drive.wheel_radius;
  f.per_wheel[1][i] = (ahead + turn) / r.drive.wheel_radius;
  f.top_speed[i] = per.top_speed;
  f.acceleration[i] = per.acceleration;
  if (!renew(world, i, now)) {
    f.cruise_until[i] = retryStep(world, now);
    return false;
  }
  f.cruising[i] = -1;
  return true;
}

void stopCruise(Fleet& f, int i) {
  if (f.cruising[i] == 0) return;
  f.cruising[i] = 0;
  f.look_again[i] = 0;
  f.cruise_until[i] = 0;
  for (int wheel = 0; wheel < 2; ++wheel) f.wheel_target[wheel][i] = f.wheel_speed[wheel][i];
}

void cruise(WorldState& world) {
  Fleet& f = world.fleet;
  const auto next = static_cast<double>(world.total_steps + 1);
  bool any_loaded = false;
  for (int begin = 0; begin < f.size(); begin += kBlock) {
    const int end = std::min(begin + kBlock, f.size());
    std::int64_t any = 0;
    for (int i = begin; i < end; ++i) {
      any |= f.cruising[i];
      any_loaded |= f.cruising[i] != 0 && f.unit[i] >= 0;
    }
    if (any == 0 || !advance(f, begin, end, world.dt, next)) continue;
    for (int i = begin; i < end; ++i) {
      if (f.cruising[i] != 0) attend(world, i, next);
    }
  }
  if (any_loaded) ++world.units_revision;
}

}  // namespace kiva
