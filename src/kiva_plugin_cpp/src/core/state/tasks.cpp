// SPDX-License-Identifier: Apache-2.0
#include "core/state/tasks.h"

#include <utility>

namespace kiva {
namespace {

void enter(WorldState& world, int robot, Phase phase, Status status, State state) {
  world.fleet.tasks[robot].phase = phase;
  moved(world.fleet, robot);
  world.setStatus(robot, status, state);
}

void becomeIdle(WorldState& world, int robot) {
  FleetState& f = world.fleet;
  Task& task = f.tasks[robot];
  for (const MotionSegment& segment : task.segments) {
    if (segment.unit >= 0 && world.units[segment.unit].claimed_by == robot) {
      world.units[segment.unit].claimed_by = -1;
    }
  }
  task.segments.clear();
  task.blocked_by = task.blocked_reason = "";
  enter(world, robot, Phase::kIdle, Status::kIdle, State::kIdle);
  f.wheel_target[0][robot] = f.wheel_target[1][robot] = 0;
}

void end(WorldState& world, int robot, Event::Kind kind, const std::string& other,
         const std::string& text) {
  becomeIdle(world, robot);
  world.fleet.last_end[robot] = static_cast<std::uint8_t>(kind);
  world.reportCommand(kind, robot, other, text);
}

void startNext(WorldState& world, int robot) {
  Task& task = world.fleet.tasks[robot];
  task.sighting = task.last_sighting = Sighting();
  task.overdue = 0;
  enter(world, robot, Phase::kStarting, Status::kBusy, task.segments.front().state);
}

}  // namespace

void beginTask(WorldState& world, int robot, std::deque<MotionSegment> segments) {
  Task& task = world.fleet.tasks[robot];
  task.segments = std::move(segments);
  world.fleet.last_end[robot] = 0;
  if (task.segments.empty()) return end(world, robot, Event::Kind::kDone, "", "is there already");
  for (const MotionSegment& segment : task.segments) {
    if (segment.kind == MotionSegment::Kind::kRaise) world.units[segment.unit].claimed_by = robot;
  }
  startNext(world, robot);
}

void finishSegment(WorldState& world, int robot) {
  Task& task = world.fleet.tasks[robot];
  if (task.isStopping()) return endStop(world, robot);
  task.segments.pop_front();
  if (!task.segments.empty()) return startNext(world, robot);
  end(world, robot, Event::Kind::kDone, "", "done: " + task.goal);
}

void stopTask(WorldState& world, int robot, Phase phase, const std::string& by,
              const std::string& reason) {
  Task& task = world.fleet.tasks[robot];
  if (task.phase == Phase::kIdle) return;
  if (!task.isStopping()) {
    task.blocked_by = by;
    task.blocked_reason = reason;
  }
  enter(world, robot, phase, Status::kBlocked, State::kBlocked);
}

void endStop(WorldState& world, int robot) {
  const Task& task = world.fleet.tasks[robot];
  const std::string by = task.blocked_by, reason = task.blocked_reason;
  end(world, robot, Event::Kind::kBlocked, by, reason);
}

void endBlocked(WorldState& world, int robot, const std::string& by, const std::string& reason) {
  Task& task = world.fleet.tasks[robot];
  if (!task.isStopping()) world.setStatus(robot, Status::kBlocked, State::kBlocked);
  end(world, robot, Event::Kind::kBlocked, by, reason);
}

void haltRobot(WorldState& world, int robot, const std::string& by, const std::string& reason) {
  const MotionSegment* at = world.fleet.tasks[robot].segment();
  if (!at) return;
  const bool moves =
      at->kind == MotionSegment::Kind::kTurn || at->kind == MotionSegment::Kind::kDrive;
  if (moves) stopTask(world, robot, Phase::kHalting, by, reason);
}

}  // namespace kiva
