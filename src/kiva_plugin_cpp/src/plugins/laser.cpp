// SPDX-License-Identifier: Apache-2.0
#include "plugins/laser.h"

#include <algorithm>
#include <cmath>

#include "core/motion/driving/drives.h"
#include "core/sensing/look_ahead.h"
#include "core/sensing/scans.h"
#include "core/state/places/footprints.h"
#include "core/state/progress/tasks.h"

namespace kiva {
namespace {

constexpr double kClearance = 0.05;  // [m] to an obstacle on a segment off the grid
constexpr double kTopApproach =
    3.0;                        // [m/s]; a faster approach is another obstacle that came into view
constexpr double kSoon = 1e-3;  // [m]

/// Returns the obstacle's own speed of approach [m/s], from two scans; 0 if unknown. An obstacle
/// that comes into view from the side may show a far corner in one scan, and its face in the next.
double approachSpeed(const Sighting& before, const Sighting& now, double between) {
  if (!now.faces || !before.faces || before.model != now.model) return 0;
  const double speed = (before.distance - now.distance - (now.along - before.along)) / between;
  return speed > 0 && speed < kTopApproach ? speed : 0;
}

/// Returns the farthest distance along the segment that the robot may drive: a grid point before
/// the obstacle's cell, or, off the grid, a clearance before the obstacle.
double farthestStop(const Scene& world, int robot, double obstacle) {
  if (!world.fleet.tasks[robot].segments.front().on_grid) {
    return obstacle - halfLength(world.fleet.robots[robot]) - kClearance;
  }
  const double cell = world.settings.grid_spacing;
  return (std::ceil(obstacle / cell - 0.5 - 1e-6) - 1) * cell;
}

/// Plans a stop at `stop`, with more than the usual deceleration if need be, or as early as
/// possible.
void planStop(RobotView& world, int i, double stop) {
  FleetState& f = world.fleet;
  const double speed = std::abs(f.command(i).speed), here = f.command(i).position;
  const double way = stop - here;
  const double usual = plannedAcceleration(world, i), hardest = plannedBraking(world, i);
  if (usual == 0) {
    f.reference_end[i] = std::max(stop, here);
    return;
  }
  const double needed = way > 0 ? speed * speed / (2 * way) : (speed > 0 ? 1e9 : 0);
  f.deceleration[i] = std::clamp(needed, usual, hardest);
  const double shortest = speed * speed / (2 * hardest) + speed * world.clock.dt;
  f.reference_end[i] = needed <= hardest ? std::max(stop, here) : here + shortest;
}

/// The result of one scan: positions along the segment [m], speeds [m/s].
struct Ahead {
  double reference;      // the robot's commanded position
  double reference_end;  // its present stop
  double obstacle;       // the obstacle's position
  double approach;       // the obstacle's own speed of approach
  double speed;          // the robot's speed
  double scan_time;      // time until the next scan [s]
};

Ahead viewOf(const Scene& world, int i) {
  const FleetState& f = world.fleet;
  const Sighting& now = f.tasks[i].sighting;
  Ahead view;
  view.reference = f.command(i).position;
  view.reference_end = f.reference_end[i];
  view.scan_time = static_cast<double>(scanPeriod(world.clock, f.robots[i])) * world.clock.dt;
  view.obstacle = now.along + now.distance;
  view.approach = approachSpeed(f.tasks[i].last_sighting, now, view.scan_time);
  view.speed = std::abs(f.command(i).speed);
  return view;
}

/// Returns the deceleration of a normal stop [m/s²].
double usualBraking(const Scene& world, int i) {
  const double usual = plannedAcceleration(world, i);
  return usual > 0 ? usual : 1e9;
}

/// Returns the position at which the robot will meet the obstacle, if that is a robot: it comes on
/// until it has seen this one, too, then brakes with the same deceleration `braking` [m/s²].
double expectedObstacle(const Ahead& view, double braking) {
  return view.obstacle - 2 * view.approach * view.scan_time -
         view.approach * view.approach / (2 * braking);
}

/// Returns the stop that the robot has to plan now; its goal if it needs none.
double firstStop(const Scene& world, int robot, const Ahead& view) {
  const auto isBehindGoal = [&](double stop) { return stop >= view.reference_end - kSoon; };
  // Most scans end here. Only the others need the braking distance.
  if (view.approach == 0 && isBehindGoal(farthestStop(world, robot, view.obstacle))) {
    return view.reference_end;
  }
  const double usual = usualBraking(world, robot);
  const double expected = expectedObstacle(view, usual);
  const double stop = farthestStop(world, robot, expected);
  if (isBehindGoal(stop)) return view.reference_end;  // its goal comes first
  const double next = farthestStop(world, robot, expected - view.approach * view.scan_time);
  const double braking = view.speed * view.speed / (2 * usual) + view.speed * view.scan_time;
  return next - view.reference > braking + kSoon ? view.reference_end
                                                 : stop;  // no need to brake yet
}

/// Returns the stop of a robot that is stopping already. It keeps its plan unless the place is
/// taken by now, or even two hard stops would hardly suffice.
double revisedStop(const Scene& world, int robot, const Ahead& view) {
  const Robot& r = world.fleet.robots[robot];
  const double hardest = plannedBraking(world, robot);
  const double gap = view.obstacle - view.reference - halfLength(r);
  const double needed = (view.speed * view.speed + view.approach * view.approach) / (2 * hardest) +
                        (view.speed + view.approach) * view.scan_time + kClearance;
  if (view.speed > 0 && gap < needed) return view.reference;
  if (view.reference_end + halfLength(r) + kClearance <= view.obstacle) return view.reference_end;
  return std::min(view.reference_end, farthestStop(world, robot, view.obstacle));
}

/// Returns whether a robot that brakes or stands on its path can go beyond its present stop.
bool mayResume(const Scene& world, int i) {
  const Task& task = world.fleet.tasks[i];
  const Ahead view = viewOf(world, i);
  if (task.sighting.model < 0 || view.obstacle >= reachOfInterest(world, i)) return true;
  const double expected = expectedObstacle(view, usualBraking(world, i));
  return farthestStop(world, i, expected) > view.reference_end + kSoon;
}

void brake(TaskView& world, int i) {
  const Task& task = world.fleet.tasks[i];
  if (!task.sighting.taken) return;
  const bool is_obstructed = task.isHeldUp() || task.phase == Phase::kBraking;
  if (task.follows() && is_obstructed && mayResume(world, i)) return resumePath(world, i);
  if (!task.drives() || task.sighting.model < 0) return;
  const Ahead view = viewOf(world, i);
  if (view.obstacle >= reachOfInterest(world, i)) return;
  const bool brakes = task.phase == Phase::kBraking;
  const double stop = brakes ? revisedStop(world, i, view) : firstStop(world, i, view);
  if (stop == view.reference_end) return;
  const std::string& name = world.models[task.sighting.model]->name;
  stopTask(world, i, Phase::kBraking, name, name + " is in the way");
  planStop(world, i, stop);
  if (task.follows() && !brakes) {  // its path goes on; the end will not report this again
    reportCommand(world, world.log, Event::Kind::kBlocked, i, name, task.blocked_reason);
  }
}

}  // namespace

void LaserPlugin::configure(Robot& robot, const Parameters& p) const {
  LaserParameters& laser = robot.laser;
  laser.fitted = true;
  laser.fields(laser, p.reader());
}

void LaserPlugin::react(TaskView& world, const std::vector<int>& sighted) const {
  for (int i : sighted) brake(world, i);
}

}  // namespace kiva
