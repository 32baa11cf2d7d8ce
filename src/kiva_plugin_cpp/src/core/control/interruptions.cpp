// SPDX-License-Identifier: Apache-2.0
#include "core/control/interruptions.h"

#include <algorithm>
#include <cmath>

#include "core/control/route.h"
#include "core/motion/driving/cruise.h"
#include "core/state/progress/tasks.h"

namespace kiva {
namespace {

/// Returns the number of segments after which a robot is back on the grid; at least the present
/// one.
std::size_t segmentsToGrid(const Task& task) {
  for (std::size_t k = task.segments.size(); k > 1; --k) {
    if (!task.segments[k - 1].on_grid) return k;
  }
  return 1;
}

bool lifts(const MotionSegment& segment) {
  return segment.kind == MotionSegment::Kind::kRaise || segment.kind == MotionSegment::Kind::kLower;
}

/// Ends a drive at the next grid point where the robot can stop.
void shortenDrive(RobotView& world, Obstacles& obstacles, int robot) {
  const FleetState& f = world.fleet;
  const double cell = world.settings.grid_spacing;
  double stop = std::ceil((f.reference[robot] - kGoalTolerance) / cell) * cell;
  while (!f.command(robot).canStopAt(stop, f.deceleration[robot], world.clock.dt)) stop += cell;
  if (stop >= f.reference_end[robot]) return;
  world.fleet.tasks[robot].segments.front().length = stop;
  setReferenceEnd(world, obstacles, robot, stop);
}

}  // namespace

void cancel(TaskView& world, Obstacles& obstacles, int robot) {
  Task& task = world.fleet.tasks[robot];
  if (task.phase == Phase::kIdle) throw Refusal("it is idle: there is nothing to cancel");
  if (task.isSteered()) throw Steered(world.fleet.robots[robot].name);
  if (task.phase == Phase::kHalting || task.phase == Phase::kAbandoning) {
    throw Refusal("its command ends already, blocked");
  }
  task.cancelled = true;
  const std::size_t rest = segmentsToGrid(task);
  if (task.phase == Phase::kWaiting) return endDone(world, robot);
  const MotionSegment& now = task.segments.front();
  if (task.phase == Phase::kStarting && rest == 1 && now.on_grid && !lifts(now)) {
    return endDone(world, robot);
  }
  task.segments.erase(task.segments.begin() + static_cast<std::ptrdiff_t>(rest),
                      task.segments.end());
  if (task.phase == Phase::kDriving && now.on_grid) shortenDrive(world, obstacles, robot);
  if (task.phase == Phase::kBraking)
    task.segments.front().length = world.fleet.reference_end[robot];
}

void stop(RobotView& world, int robot) {
  FleetState& f = world.fleet;
  if (f.stopped[robot]) return;
  f.stopped[robot] = 1;
  if (f.awake[robot]) moved(f, robot);
}

void goOn(RobotView& world, int robot) {
  FleetState& f = world.fleet;
  if (!f.stopped[robot]) return;
  f.stopped[robot] = 0;
  if (!isHeld(f, robot)) replan(world, robot);
}

void replan(RobotView& world, int robot) {
  FleetState& f = world.fleet;
  Task& task = f.tasks[robot];
  moved(f, robot);
  const bool resumes = task.phase == Phase::kDriving || task.phase == Phase::kTurning ||
                       task.phase == Phase::kLifting;
  if (resumes) task.phase = Phase::kStarting;  // planned again, from its present pose
  task.sighting = task.last_sighting = Sighting();
  task.overdue = 0;
  task.stop_at = Profile::kNowhere;
}

}  // namespace kiva
