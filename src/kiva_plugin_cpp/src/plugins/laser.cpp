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

/// What one look tells: places along the leg [m], speeds [m/s].
struct View {
  double obstacle;   // where it is now
  double approach;   // how fast it comes by itself
  double speed;      // of this robot
  double scan_time;  // until the next look [s]
  int model;
};

View look(const Parts& parts, Robot& r, int i) {
  const double along = alongLeg(parts.fleet, i);
  const Ahead ahead = lookAhead(parts, i);
  View view;
  view.scan_time = static_cast<double>(period(parts, r)) * parts.dt;
  view.obstacle = along + ahead.distance;
  view.approach = approachSpeed(r, ahead, along, view.scan_time);
  view.speed = std::abs(r.profile.speed);
  view.model = ahead.model;
  r.seen_distance = ahead.model < 0 ? 0 : ahead.distance;
  r.seen_from = along;
  r.seen_model = ahead.model;
  return view;
}

/// Where the robot has to plan its stop now, if it has to; else its goal.
double firstStop(const Parts& parts, const Robot& r, const View& view) {
  const double usual = r.drive.acceleration > 0 ? r.drive.acceleration : 1e9;
  // The other one comes on until it has seen this robot too, then brakes as this one does.
  const double comes =
      2 * view.approach * view.scan_time + view.approach * view.approach / (2 * usual);
  const double expected = view.obstacle - comes;
  const double stop = farthestStop(parts, r, expected);
  if (stop >= r.goal - kSoon) return r.goal;  // the way ends before, anyway
  const double next = farthestStop(parts, r, expected - view.approach * view.scan_time);
  const double braking = view.speed * view.speed / (2 * usual) + view.speed * view.scan_time;
  return next - r.profile.position > braking + kSoon ? r.goal : stop;  // while there is time
}

/// The same for a robot that is stopping already: it keeps to its plan unless the place is taken
/// by now, or even two hard stops would hardly do.
double revisedStop(const Parts& parts, const Robot& r, const View& view) {
  const double hardest = r.drive.emergency_deceleration;
  const double gap = view.obstacle - r.profile.position - reach(r);
  const double needed = (view.speed * view.speed + view.approach * view.approach) / (2 * hardest) +
                        (view.speed + view.approach) * view.scan_time + kClearance;
  if (view.speed > 0 && gap < needed) return r.profile.position;
  if (r.goal + reach(r) + kClearance <= view.obstacle) return r.goal;
  return std::min(r.goal, farthestStop(parts, r, view.obstacle));
}

void guard(Parts& parts, int i) {
  Robot& r = parts.fleet.robots[i];
  const View view = look(parts, r, i);
  if (view.model < 0) return;
  const double stop = r.stopping ? revisedStop(parts, r, view) : firstStop(parts, r, view);
  if (stop == r.goal) return;
  const std::string& name = parts.models[view.model]->name;
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
