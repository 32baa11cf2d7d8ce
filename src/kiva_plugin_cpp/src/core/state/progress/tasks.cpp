// SPDX-License-Identifier: Apache-2.0
#include "core/state/progress/tasks.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/state/progress/path_progress.h"

namespace kiva {
namespace {

constexpr double kAstray = 0.05;  // [m] from its point at which it can't begin its next run
constexpr std::uint32_t kPointsToKeep = 64;  // left points of a path that are kept

void becomeIdle(TaskView& world, int robot) {
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

/// Holds a steered robot until its client asks it to stop.
void holdSteered(TaskView& world, int robot, const std::string& by, const std::string& reason) {
  Steering& steering = world.fleet.steering(robot);
  if (steering.bumped) return;
  steering.bumped = true;
  moved(world.fleet, robot);
  setStatus(world, robot, Status::kBlocked, State::kBlocked);
  reportCommand(world, world.log, Event::Kind::kBlocked, robot, by, reason);
}

void end(TaskView& world, int robot, Event::Kind kind, const std::string& other,
         const std::string& text) {
  becomeIdle(world, robot);
  world.fleet.last_end[robot] = static_cast<std::uint8_t>(kind);
  reportCommand(world, world.log, kind, robot, other, text);
}

}  // namespace

void setStatus(TaskView& world, int robot, Status status, State state) {
  FleetState& f = world.fleet;
  Task& task = f.tasks[robot];
  const int unit = f.unit[robot];
  const int unit_id = unit < 0 ? 0 : world.storage.units[unit].id;
  if (f.status[robot] == status && f.state[robot] == state && task.reported_unit_id == unit_id)
    return;
  f.status[robot] = status;
  f.state[robot] = state;
  task.reported_unit_id = unit_id;
  if (f.failures[robot] & bitOf(Failure::kRadio)) return;
  const int id = f.robots[robot].id;
  if (world.settings.realism.radio.delaysReports()) return world.report_link.changed.push_back(id);
  world.log.status_changes.push_back(
      {world.clock.time(), id, status, state, unit_id, f.x[robot], f.y[robot], f.yaw[robot]});
}

void reportCommand(const Scene& world, EventLog& log, Event::Kind kind, int robot,
                   const std::string& other, const std::string& text) {
  const FleetState& f = world.fleet;
  log.report(kind, f.robots[robot].name, other, text, {}, f.tasks[robot].command);
}

void enterPhase(TaskView& world, int robot, Phase phase, Status status, State state) {
  world.fleet.tasks[robot].phase = phase;
  moved(world.fleet, robot);
  setStatus(world, robot, status, state);
}

void startSegment(TaskView& world, int robot) {
  Task& task = world.fleet.tasks[robot];
  task.sighting = task.last_sighting = Sighting();
  task.overdue = 0;
  task.stop_at = Profile::kNowhere;
  enterPhase(world, robot, Phase::kStarting, Status::kBusy, task.segments.front().state);
}

void beginTask(TaskView& world, int robot, std::deque<MotionSegment> segments) {
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

void beginPath(TaskView& world, int robot, std::uint32_t id, ReleasedPath path,
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

void continuePath(TaskView& world, int robot) {
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

void resumePath(TaskView& world, int robot) {
  FleetState& f = world.fleet;
  Task& task = f.tasks[robot];
  task.blocked_by = task.blocked_reason = "";
  if (task.phase != Phase::kBraking) return startSegment(world, robot);
  const MotionSegment& run = task.segments.front();
  f.reference_end[robot] = run.length;
  f.deceleration[robot] = f.acceleration[robot];
  enterPhase(world, robot, Phase::kDriving, Status::kBusy, run.state);
}

void finishSegment(TaskView& world, int robot) {
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

void endDone(TaskView& world, int robot) {
  const Task& task = world.fleet.tasks[robot];
  end(world, robot, Event::Kind::kDone, "", task.cancelled ? "cancelled" : "done: " + task.request);
}

void stopTask(TaskView& world, int robot, Phase phase, const std::string& by,
              const std::string& reason) {
  Task& task = world.fleet.tasks[robot];
  if (task.phase == Phase::kIdle) return;
  if (!task.isStopping()) {
    task.blocked_by = by;
    task.blocked_reason = reason;
  }
  enterPhase(world, robot, phase, Status::kBlocked, State::kBlocked);
}

void endStop(TaskView& world, int robot) {
  const Task& task = world.fleet.tasks[robot];
  const std::string by = task.blocked_by, reason = task.blocked_reason;
  end(world, robot, Event::Kind::kBlocked, by, reason);
}

void endBlocked(TaskView& world, int robot, const std::string& by, const std::string& reason) {
  Task& task = world.fleet.tasks[robot];
  if (!task.isStopping()) setStatus(world, robot, Status::kBlocked, State::kBlocked);
  end(world, robot, Event::Kind::kBlocked, by, reason);
}

void haltRobot(TaskView& world, int robot, const std::string& by, const std::string& reason) {
  const Task& task = world.fleet.tasks[robot];
  if (task.isSteered()) return holdSteered(world, robot, by, reason);
  if (task.phase == Phase::kWaiting) return endBlocked(world, robot, by, reason);
  if (task.movesOnFloor()) stopTask(world, robot, Phase::kHalting, by, reason);
}

}  // namespace kiva
