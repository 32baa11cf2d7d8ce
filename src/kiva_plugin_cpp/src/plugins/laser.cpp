// SPDX-License-Identifier: Apache-2.0
#include "laser.h"

#include <algorithm>
#include <cmath>

#include "../core/commands.h"
#include "../core/sensing.h"

namespace kiva {
namespace {

constexpr double kClearance = 0.05;   // [m] kept to an obstacle on a way off the grid
constexpr double kTopApproach = 3.0;  // [m/s]; what comes faster is another thing come into view
constexpr double kSoon = 1e-3;        // [m]

std::uint64_t period(const Parts& parts, const Robot& robot) {
  return std::max<std::uint64_t>(1, std::llround(1 / (robot.laser.rate * parts.dt)));
}

double alongLeg(const Fleet& f, int i) {
  const Leg& leg = f.robots[i].legs.front();
  return std::cos(leg.yaw) * (f.x[i] - leg.x) + std::sin(leg.yaw) * (f.y[i] - leg.y);
}

/// Speed [m/s] at which what is ahead comes nearer by itself, from two looks; 0 if unknown.
double approachSpeed(const Robot& r, const Ahead& ahead, double along, double between) {
  if (r.seen_model != ahead.model || r.seen_distance <= 0) return 0;
  const double speed = (r.seen_distance - ahead.distance - (along - r.seen_from)) / between;
  return speed > 0 && speed < kTopApproach ? speed : 0;
}

/// From the robot's centre to the front of it and its load [m].
double reach(const Robot& r) { return std::max(r.half_length, r.load_half_length); }

/// How far along the leg the robot may go: a grid point before the cell of what is ahead, or, off
/// the grid, a little before it.
double farthestStop(const Parts& parts, const Robot& r, double obstacle) {
  if (!r.legs.front().on_grid) {
    return obstacle - reach(r) - kClearance;
  }
  const double cell = parts.grid_spacing;
  return (std::ceil(obstacle / cell - 0.5 - 1e-6) - 1) * cell;
}

/// Plans the stop at `stop`, braking harder than usual if it must be, or as soon as it can be.
void planStop(Robot& r, double stop, double dt) {
  const double speed = std::abs(r.profile.speed);
  const double way = stop - r.profile.position;
  const double usual = r.drive.acceleration, hardest = r.drive.emergency_deceleration;
  if (usual == 0) {
    r.goal = std::max(stop, r.profile.position);
    return;
  }
  const double needed = way > 0 ? speed * speed / (2 * way) : (speed > 0 ? 1e9 : 0);
  r.deceleration = std::clamp(needed, usual, hardest);
  const double shortest = speed * speed / (2 * hardest) + speed * dt;
  r.goal = needed <= hardest ? std::max(stop, r.profile.position) : r.profile.position + shortest;
}

void guard(Parts& parts, int i) {
  Robot& r = parts.fleet.robots[i];
  const double scan_time = static_cast<double>(period(parts, r)) * parts.dt;
  const double along = alongLeg(parts.fleet, i);
  const Ahead ahead = lookAhead(parts, i);
  const double approach = approachSpeed(r, ahead, along, scan_time);
  r.seen_distance = ahead.model < 0 ? 0 : ahead.distance;
  r.seen_from = along;
  r.seen_model = ahead.model;
  if (ahead.model < 0) return;

  const double usual = r.drive.acceleration > 0 ? r.drive.acceleration : 1e9;
  // Until the other one has seen this robot too, it comes on.
  const double comes = 2 * approach * scan_time + approach * approach / (2 * usual);
  const double obstacle = along + ahead.distance - comes;
  const double stop = farthestStop(parts, r, obstacle);
  if (stop >= r.goal - kSoon) return;                                    // it ends before, anyway
  if (r.stopping && r.goal + reach(r) + kClearance <= obstacle) return;  // it will be in time
  const double speed = std::abs(r.profile.speed);
  const double braking = speed * speed / (2 * usual) + speed * scan_time;
  const double next_stop = farthestStop(parts, r, obstacle - approach * scan_time);
  if (!r.stopping && next_stop - r.profile.position > braking + kSoon) return;  // there is time
  const std::string& name = parts.models[ahead.model]->name;
  markBlocked(parts, i, name, name + " is in the way");
  planStop(r, stop, parts.dt);
}

bool isOnGuard(const Robot& r) {
  return r.laser.fitted && !r.legs.empty() && r.leg_started && !r.halting &&
         r.legs.front().kind == Leg::Kind::kDrive && !r.legs.front().reverse;
}

}  // namespace

bool isScanDue(const Parts& parts, int robot) {
  const Robot& r = parts.fleet.robots[robot];
  if (!r.laser.fitted) return false;
  const std::uint64_t steps = period(parts, r);
  // Weyl's sequence by the golden ratio spreads any set of ids evenly.
  const double spread = std::fmod(r.id * 0.6180339887498949, 1.0);
  const auto offset = static_cast<std::uint64_t>(spread * static_cast<double>(steps));
  return (parts.total_steps + offset) % steps == 0;
}

void LaserPlugin::configure(Robot& robot, const Parameters& p) const {
  LaserParameters& laser = robot.laser;
  laser.fitted = true;
  laser.rays = p.whole("rays", laser.rays, 1, 10000);
  laser.min_angle = p.number("min_angle", laser.min_angle, -M_PI, M_PI);
  laser.max_angle = p.number("max_angle", laser.max_angle, laser.min_angle, M_PI);
  laser.min_range = p.number("min_range", laser.min_range, 0, 100);
  laser.max_range = p.number("max_range", laser.max_range, laser.min_range, 100);
  laser.rate = p.number("rate", laser.rate, 0.01, 1000);
  laser.x = p.number("x", laser.x, -10, 10);
  laser.z = p.number("z", laser.z, 0, 10);
}

void LaserPlugin::afterStep(Parts& parts) {
  Fleet& f = parts.fleet;
  for (int i = 0; i < f.size(); ++i) {
    if (!f.awake[i] || !isOnGuard(f.robots[i])) continue;
    if (!f.robots[i].look_now && !isScanDue(parts, i)) continue;
    f.robots[i].look_now = false;
    guard(parts, i);
  }
}

}  // namespace kiva
