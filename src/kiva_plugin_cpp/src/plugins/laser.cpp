// SPDX-License-Identifier: Apache-2.0
#include "plugins/laser.h"

#include <algorithm>
#include <cmath>

#include "core/control/commands.h"
#include "core/motion/cruise.h"
#include "core/motion/drives.h"
#include "core/sensing/sensing.h"

namespace kiva {
namespace {

constexpr double kClearance = 0.05;   // [m] kept to an obstacle on a way off the grid
constexpr double kTopApproach = 3.0;  // [m/s]; what comes faster is another thing come into view
constexpr double kSoon = 1e-3;        // [m]

double alongSegment(const Fleet& f, int i) {
  const MotionSegment& segment = f.robots[i].segments.front();
  return std::cos(segment.yaw) * (f.x[i] - segment.x) +
         std::sin(segment.yaw) * (f.y[i] - segment.y);
}

/// Speed [m/s] at which what is ahead comes nearer by itself, from two looks; 0 if unknown. Of what
/// comes into view from the side, one look may meet a corner far back, and the next its face.
double approachSpeed(const Robot& r, const Ahead& ahead, double along, double between) {
  if (!ahead.faces || r.seen_model != ahead.model || r.seen_distance <= 0) return 0;
  const double speed = (r.seen_distance - ahead.distance - (along - r.seen_from)) / between;
  return speed > 0 && speed < kTopApproach ? speed : 0;
}

/// From the robot's centre to the front of it and its load [m].
double reach(const Robot& r) { return std::max(r.half_length, r.load_half_length); }

/// How far along the segment the robot may go: a grid point before the cell of what is ahead, or,
/// off the grid, a little before it.
double farthestStop(const WorldState& world, const Robot& r, double obstacle) {
  if (!r.segments.front().on_grid) {
    return obstacle - reach(r) - kClearance;
  }
  const double cell = world.grid_spacing;
  return (std::ceil(obstacle / cell - 0.5 - 1e-6) - 1) * cell;
}

/// Plans the stop at `stop`, braking harder than usual if it must be, or as soon as it can be.
void planStop(WorldState& world, int i, double stop) {
  Fleet& f = world.fleet;
  const double speed = std::abs(f.reference_speed[i]), here = f.reference[i];
  const double way = stop - here;
  const double usual = plannedAcceleration(world, i), hardest = plannedBraking(world, i);
  if (usual == 0) {
    f.goal[i] = std::max(stop, here);
    return;
  }
  const double needed = way > 0 ? speed * speed / (2 * way) : (speed > 0 ? 1e9 : 0);
  f.deceleration[i] = std::clamp(needed, usual, hardest);
  const double shortest = speed * speed / (2 * hardest) + speed * world.dt;
  f.goal[i] = needed <= hardest ? std::max(stop, here) : here + shortest;
}

/// What one look tells: places along the segment [m], speeds [m/s].
struct View {
  double reference;  // where this robot is to be now
  double goal;       // where it is to stop so far
  double obstacle;   // where it is now
  double approach;   // how fast it comes by itself
  double speed;      // of this robot
  double usual;      // its braking, and
  double hardest;    // that for an obstacle [m/s²]
  double scan_time;  // until the next look [s]
  int model;
};

View look(WorldState& world, Robot& r, int i) {
  const double along = alongSegment(world.fleet, i);
  const Ahead ahead = lookAhead(world, i);
  View view;
  view.reference = world.fleet.reference[i];
  view.goal = world.fleet.goal[i];
  view.scan_time = static_cast<double>(scanPeriod(world, r)) * world.dt;
  view.obstacle = along + ahead.distance;
  view.approach = approachSpeed(r, ahead, along, view.scan_time);
  view.speed = std::abs(world.fleet.reference_speed[i]);
  const double usual = plannedAcceleration(world, i);
  view.usual = usual > 0 ? usual : 1e9;
  view.hardest = plannedBraking(world, i);
  view.model = ahead.model;
  r.seen_distance = ahead.faces ? ahead.distance : 0;
  r.seen_from = along;
  r.seen_model = ahead.model;
  return view;
}

/// Where the robot has to plan its stop now, if it has to; else its goal.
double firstStop(const WorldState& world, const Robot& r, const View& view) {
  // The other one comes on until it has seen this robot too, then brakes as this one does.
  const double comes =
      2 * view.approach * view.scan_time + view.approach * view.approach / (2 * view.usual);
  const double expected = view.obstacle - comes;
  const double stop = farthestStop(world, r, expected);
  if (stop >= view.goal - kSoon) return view.goal;  // the way ends before, anyway
  const double next = farthestStop(world, r, expected - view.approach * view.scan_time);
  const double braking = view.speed * view.speed / (2 * view.usual) + view.speed * view.scan_time;
  return next - view.reference > braking + kSoon ? view.goal : stop;  // while there is time
}

/// The same for a robot that is stopping already: it keeps to its plan unless the place is taken
/// by now, or even two hard stops would hardly do.
double revisedStop(const WorldState& world, const Robot& r, const View& view) {
  const double gap = view.obstacle - view.reference - reach(r);
  const double needed =
      (view.speed * view.speed + view.approach * view.approach) / (2 * view.hardest) +
      (view.speed + view.approach) * view.scan_time + kClearance;
  if (view.speed > 0 && gap < needed) return view.reference;
  if (view.goal + reach(r) + kClearance <= view.obstacle) return view.goal;
  return std::min(view.goal, farthestStop(world, r, view.obstacle));
}

void guard(WorldState& world, int i) {
  Robot& r = world.fleet.robots[i];
  const View view = look(world, r, i);
  if (view.model < 0) return;
  const double stop = r.stopping ? revisedStop(world, r, view) : firstStop(world, r, view);
  if (stop == view.goal) return;
  const std::string& name = world.models[view.model]->name;
  markBlocked(world, i, name, name + " is in the way");
  stopCruise(world.fleet, i);
  planStop(world, i, stop);
}

bool isOnGuard(const Robot& r) {
  return r.laser.fitted && !r.segments.empty() && r.segment_started && !r.halting &&
         r.segments.front().kind == MotionSegment::Kind::kDrive && !r.segments.front().reverse;
}

}  // namespace

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

void LaserPlugin::afterStep(WorldState& world) {
  Fleet& f = world.fleet;
  const auto watch = [&](int i) {
    if (!isOnGuard(f.robots[i])) return;
    f.robots[i].look_now = false;
    guard(world, i);
  };
  for (int i : world.scans_due) {
    if (f.awake[i]) watch(i);
  }
  for (int i : world.stepped_singly) {
    if (f.robots[i].look_now) watch(i);
  }
}

}  // namespace kiva
