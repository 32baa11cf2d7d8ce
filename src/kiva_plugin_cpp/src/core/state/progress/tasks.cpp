// SPDX-License-Identifier: Apache-2.0
#include "core/state/progress/tasks.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/state/progress/path_progress.h"

namespace kiva {
namespace {

constexpr double kAstray = 0.05;             // [m] from its point: it can't begin its next run
constexpr std::uint32_t kPointsToKeep = 64;  // left points of a path before they are forgotten

void becomeIdle(MotionView& world, int robot) {
  FleetState& f = world.fleet;
  Task& task = f.tasks[robot];
  for (const MotionSegment& segment : task.segments) {
    if (segment.unit >= 0 && world.storage.units[segment.unit].claimed_by == robot) {
      world.storage.units[segment.unit].claimed_by = -1;
    }
  }
  task.segments.clear();
  task.blocked_by = task.blocked_reason = "";
  task.path = ReleasedPath();
  task.cancelled = false;
  enterPhase(world, robot, Phase::kIdle, Status::kIdle, State::kIdle);
  f.wheel_target[0][robot] = f.wheel_target[1][robot] = 0;
}

void end(MotionView& world, int robot, Event::Kind kind, const std::string& other,
         const std::string& text) {
  becomeIdle(world, robot);
  world.fleet.last_end[robot] = static_cast<std::uint8_t>(kind);
  reportCommand(world, kind, robot, other, text);
}

}  // namespace

void setStatus(MotionView& world, int robot, Status status, State state) {
  FleetState& f = world.fleet;
  Task& task = f.tasks[robot];
  const int unit = f.unit[robot];
  const int shelf = unit < 0 ? 0 : world.storage.units[unit].id;
  if (f.status[robot] == status && f.state[robot] == state && task.reported_shelf == shelf) return;
  f.status[robot] = status;
  f.state[robot] = state;
  task.reported_shelf = shelf;
  if (f.failures[robot] & bitOf(Failure::kRadio)) return;
  const int id = f.robots[robot].id;
  if (world.settings.realism.radio.delaysReports()) return world.report_link.changed.push_back(id);
  world.log.status_changes.push_back(
      {world.clock.time(), id, status, state, shelf, f.x[robot], f.y[robot], f.yaw[robot]});
}

void reportCommand(MotionView& world, Event::Kind kind, int robot, const std::string& other,
                   const std::string& text) {
  const FleetState& f = world.fleet;
  world.log.report(kind, f.robots[robot].name, other, text, {}, f.tasks[robot].command);
}

void enterPhase(MotionView& world, int robot, Phase phase, Status status, State state) {
  world.fleet.tasks[robot].phase = phase;
  moved(world.fleet, robot);
  setStatus(world, robot, status, state);
}

void startSegment(MotionView& world, int robot) {
  Task& task = world.fleet.tasks[robot];
  task.sighting = task.last_sighting = Sighting();
  task.overdue = 0;
  task.stop_at = Profile::kNowhere;
  enterPhase(world, robot, Phase::kStarting, Status::kBusy, task.segments.front().state);
}

void beginTask(MotionView& world, int robot, std::deque<MotionSegment> segments) {
  Task& task = world.fleet.tasks[robot];
  task.segments = std::move(segments);
  FleetState& f = world.fleet;
  f.last_end[robot] = 0;
  f.path_id[robot] = f.reached[robot] = f.left[robot] = 0;
  if (task.segments.empty()) return end(world, robot, Event::Kind::kDone, "", "is there already");
  for (const MotionSegment& segment : task.segments) {
    if (segment.kind == MotionSegment::Kind::kRaise)
      world.storage.units[segment.unit].claimed_by = robot;
  }
  startSegment(world, robot);
}

void beginPath(MotionView& world, int robot, std::uint32_t id, ReleasedPath path,
               std::deque<MotionSegment> segments) {
  FleetState& f = world.fleet;
  Task& task = f.tasks[robot];
  task.path = std::move(path);
  task.segments = std::move(segments);
  f.path_id[robot] = id;
  f.reached[robot] = 1;
  f.left[robot] = 0;
  f.last_end[robot] = 0;
  if (task.segments.empty()) return continuePath(world, robot);
  startSegment(world, robot);
}

void continuePath(MotionView& world, int robot) {
  Task& task = world.fleet.tasks[robot];
  ReleasedPath& path = task.path;
  path.origin = path.end;
  if (path.origin > path.first + kPointsToKeep) {
    path.forgetBefore(std::min(path.origin, world.fleet.left[robot]));
  }
  if (path.origin + 1 == path.size()) return endDone(world, robot);
  if (path.origin + 1 >= path.released) {
    return enterPhase(world, robot, Phase::kWaiting, Status::kBusy, State::kWaiting);
  }
  const PlanarPose at = world.fleet.believed(robot);
  const double astray = std::hypot(at.x - path[path.origin].x, at.y - path[path.origin].y);
  if (astray > kAstray) return endBlocked(world, robot, "", "was pushed off its path");
  path.extendRun();
  task.segments.push_back(nextSegment(world, robot));
  if (task.segments.front().kind == MotionSegment::Kind::kTurn) path.end = path.origin;
  startSegment(world, robot);
}

void resumePath(MotionView& world, int robot) {
  FleetState& f = world.fleet;
  Task& task = f.tasks[robot];
  task.blocked_by = task.blocked_reason = "";
  if (task.phase != Phase::kBraking) return startSegment(world, robot);
  const MotionSegment& run = task.segments.front();
  f.goal[robot] = run.goal;
  f.deceleration[robot] = f.acceleration[robot];
  enterPhase(world, robot, Phase::kDriving, Status::kBusy, run.state);
}

void finishSegment(MotionView& world, int robot) {
  Task& task = world.fleet.tasks[robot];
  const bool is_held_up = task.phase == Phase::kBraking && task.follows();
  if (is_held_up && !task.cancelled) {
    return enterPhase(world, robot, Phase::kWaiting, Status::kBlocked, State::kBlocked);
  }
  if (task.isStopping() && !is_held_up) return endStop(world, robot);
  task.segments.pop_front();
  if (!task.segments.empty()) return startSegment(world, robot);
  if (task.follows() && !task.cancelled) return continuePath(world, robot);
  endDone(world, robot);
}

void endDone(MotionView& world, int robot) {
  const Task& task = world.fleet.tasks[robot];
  end(world, robot, Event::Kind::kDone, "", task.cancelled ? "cancelled" : "done: " + task.goal);
}

void stopTask(MotionView& world, int robot, Phase phase, const std::string& by,
              const std::string& reason) {
  Task& task = world.fleet.tasks[robot];
  if (task.phase == Phase::kIdle) return;
  if (!task.isStopping()) {
    task.blocked_by = by;
    task.blocked_reason = reason;
  }
  enterPhase(world, robot, phase, Status::kBlocked, State::kBlocked);
}

void endStop(MotionView& world, int robot) {
  const Task& task = world.fleet.tasks[robot];
  const std::string by = task.blocked_by, reason = task.blocked_reason;
  end(world, robot, Event::Kind::kBlocked, by, reason);
}

void endBlocked(MotionView& world, int robot, const std::string& by, const std::string& reason) {
  Task& task = world.fleet.tasks[robot];
  if (!task.isStopping()) setStatus(world, robot, Status::kBlocked, State::kBlocked);
  end(world, robot, Event::Kind::kBlocked, by, reason);
}

void haltRobot(MotionView& world, int robot, const std::string& by, const std::string& reason) {
  const Task& task = world.fleet.tasks[robot];
  if (task.phase == Phase::kWaiting) return endBlocked(world, robot, by, reason);
  if (task.movesOnFloor()) stopTask(world, robot, Phase::kHalting, by, reason);
}

}  // namespace kiva
