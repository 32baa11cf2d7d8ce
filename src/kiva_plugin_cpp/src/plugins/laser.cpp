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

constexpr double kClearance = 0.05;   // [m] kept to an obstacle on a way off the grid
constexpr double kTopApproach = 3.0;  // [m/s]; what comes faster is another thing come into view
constexpr double kSoon = 1e-3;        // [m]

/// Speed [m/s] at which what is ahead comes nearer by itself, from two looks; 0 if unknown. Of what
/// comes into view from the side, one look may meet a corner far back, and the next its face.
double approachSpeed(const Sighting& before, const Sighting& now, double between) {
  if (!now.faces || !before.faces || before.model != now.model) return 0;
  const double speed = (before.distance - now.distance - (now.along - before.along)) / between;
  return speed > 0 && speed < kTopApproach ? speed : 0;
}

/// Returns how far along the segment the robot may go: a grid point before the cell of what is
/// ahead, or, off the grid, a little before it.
double farthestStop(const Scene& world, int robot, double obstacle) {
  if (!world.fleet.tasks[robot].segments.front().on_grid) {
    return obstacle - halfLength(world.fleet.robots[robot]) - kClearance;
  }
  const double cell = world.settings.grid_spacing;
  return (std::ceil(obstacle / cell - 0.5 - 1e-6) - 1) * cell;
}

/// Plans the stop at `stop`, braking harder than usual if it must be, or as soon as it can be.
void planStop(MotionView& world, int i, double stop) {
  FleetState& f = world.fleet;
  const double speed = std::abs(f.command(i).speed), here = f.command(i).position;
  const double way = stop - here;
  const double usual = plannedAcceleration(world, i), hardest = plannedBraking(world, i);
  if (usual == 0) {
    f.goal[i] = std::max(stop, here);
    return;
  }
  const double needed = way > 0 ? speed * speed / (2 * way) : (speed > 0 ? 1e9 : 0);
  f.deceleration[i] = std::clamp(needed, usual, hardest);
  const double shortest = speed * speed / (2 * hardest) + speed * world.clock.dt;
  f.goal[i] = needed <= hardest ? std::max(stop, here) : here + shortest;
}

/// What one look tells: places along the segment [m], speeds [m/s].
struct View {
  double reference;  // where this robot is commanded to be now
  double goal;       // where it is to stop so far
  double obstacle;   // where it is now
  double approach;   // how fast it comes by itself
  double speed;      // of this robot
  double scan_time;  // until the next look [s]
};

View viewOf(const Scene& world, int i) {
  const FleetState& f = world.fleet;
  const Sighting& now = f.tasks[i].sighting;
  View view;
  view.reference = f.command(i).position;
  view.goal = f.goal[i];
  view.scan_time = static_cast<double>(scanPeriod(world.clock, f.robots[i])) * world.clock.dt;
  view.obstacle = now.along + now.distance;
  view.approach = approachSpeed(f.tasks[i].last_sighting, now, view.scan_time);
  view.speed = std::abs(f.command(i).speed);
  return view;
}

/// [m/s²]
double usualBraking(MotionView& world, int i) {
  const double usual = plannedAcceleration(world, i);
  return usual > 0 ? usual : 1e9;
}

/// Returns where the obstacle is to be met: the other one comes on until it has seen this robot
/// too, then brakes as this one does, with `braking` [m/s²].
double expectedObstacle(const View& view, double braking) {
  return view.obstacle - 2 * view.approach * view.scan_time -
         view.approach * view.approach / (2 * braking);
}

/// Returns where the robot has to plan its stop now, if it has to; else its goal.
double firstStop(MotionView& world, int robot, const View& view) {
  const auto isBehindGoal = [&](double stop) { return stop >= view.goal - kSoon; };
  // Most looks end here: how it can brake is worked out for the others alone.
  if (view.approach == 0 && isBehindGoal(farthestStop(world, robot, view.obstacle))) {
    return view.goal;
  }
  const double usual = usualBraking(world, robot);
  const double expected = expectedObstacle(view, usual);
  const double stop = farthestStop(world, robot, expected);
  if (isBehindGoal(stop)) return view.goal;  // its way ends before, anyway
  const double next = farthestStop(world, robot, expected - view.approach * view.scan_time);
  const double braking = view.speed * view.speed / (2 * usual) + view.speed * view.scan_time;
  return next - view.reference > braking + kSoon ? view.goal : stop;  // while there is time
}

/// Returns the same for a robot that is stopping already: it keeps to its plan unless the place is
/// taken by now, or even two hard stops would hardly do.
double revisedStop(MotionView& world, int robot, const View& view) {
  const Robot& r = world.fleet.robots[robot];
  const double hardest = plannedBraking(world, robot);
  const double gap = view.obstacle - view.reference - halfLength(r);
  const double needed = (view.speed * view.speed + view.approach * view.approach) / (2 * hardest) +
                        (view.speed + view.approach) * view.scan_time + kClearance;
  if (view.speed > 0 && gap < needed) return view.reference;
  if (view.goal + halfLength(r) + kClearance <= view.obstacle) return view.goal;
  return std::min(view.goal, farthestStop(world, robot, view.obstacle));
}

/// Returns whether a robot that brakes or stands on its path can go farther than to where it does.
bool mayResume(MotionView& world, int i) {
  const Task& task = world.fleet.tasks[i];
  const View view = viewOf(world, i);
  if (task.sighting.model < 0 || view.obstacle >= reachOfInterest(world, i)) return true;
  const double expected = expectedObstacle(view, usualBraking(world, i));
  return farthestStop(world, i, expected) > view.goal + kSoon;
}

void brake(MotionView& world, int i) {
  const Task& task = world.fleet.tasks[i];
  if (!task.sighting.taken) return;
  const bool is_obstructed = task.isHeldUp() || task.phase == Phase::kBraking;
  if (task.follows() && is_obstructed && mayResume(world, i)) return resumePath(world, i);
  if (!task.drives() || task.sighting.model < 0) return;
  const View view = viewOf(world, i);
  if (view.obstacle >= reachOfInterest(world, i)) return;
  const bool brakes = task.phase == Phase::kBraking;
  const double stop = brakes ? revisedStop(world, i, view) : firstStop(world, i, view);
  if (stop == view.goal) return;
  const std::string& name = world.models[task.sighting.model]->name;
  stopTask(world, i, Phase::kBraking, name, name + " is in the way");
  planStop(world, i, stop);
  if (task.follows() && !brakes) {  // its path goes on: this is not told again at its end
    reportCommand(world, Event::Kind::kBlocked, i, name, task.blocked_reason);
  }
}

}  // namespace

void LaserPlugin::configure(Robot& robot, const Parameters& p) const {
  LaserParameters& laser = robot.laser;
  laser.fitted = true;
  laser.fields(laser, p.reader());
}

void LaserPlugin::react(MotionView& world, const std::vector<int>& sighted) const {
  for (int i : sighted) brake(world, i);
}

}  // namespace kiva
