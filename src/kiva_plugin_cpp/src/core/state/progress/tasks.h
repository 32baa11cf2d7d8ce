// SPDX-License-Identifier: Apache-2.0
//
// The phases of robots: a command begins and proceeds through its segments, until it is done or
// blocked.
#pragma once

#include <deque>
#include <string>

#include "core/state/views/task_view.h"

namespace kiva {

/// Begins the segments of the robot's command; without segments it is done.
void beginTask(TaskView& world, int robot, std::deque<MotionSegment> segments);
/// Begins a path; `segments` bring the robot to its point 0.
void beginPath(TaskView& world, int robot, std::uint32_t id, ReleasedPath path,
               std::deque<MotionSegment> segments);
/// Continues a path on one of its points, at the end of a run or of a turn: the robot turns,
/// drives, waits for a release, or is done.
void continuePath(TaskView& world, int robot);
/// Lets a robot that brakes or stands on its path go on, since its way is free again.
void resumePath(TaskView& world, int robot);
/// Begins the robot's first segment at the next step, unless it is stopped.
void startSegment(TaskView& world, int robot);
/// Ends the current segment: the next one begins, or the command is DONE, or BLOCKED if it was
/// stopping.
void finishSegment(TaskView& world, int robot);
/// Ends the command in BLOCKED as soon as the robot has completed `phase`: kBraking, kHalting or
/// kAbandoning. The robot reports BLOCKED from now on; the first of several reasons counts.
void stopTask(TaskView& world, int robot, Phase phase, const std::string& by,
              const std::string& reason);
/// Ends a stop: BLOCKED, then idle.
void endStop(TaskView& world, int robot);
/// Ends the command as done, or as cancelled.
void endDone(TaskView& world, int robot);
/// Ends the command in BLOCKED at once, in any phase.
void endBlocked(TaskView& world, int robot, const std::string& by, const std::string& reason);
/// Locks the wheels of a robot that turns or drives, at once. A robot that lifts stands anyway; a
/// path on which it stands ends; a steered robot stands until its client asks it to stop.
void haltRobot(TaskView& world, int robot, const std::string& by, const std::string& reason);
/// Sets the status that the robot reports, and records a change.
void setStatus(TaskView& world, int robot, Status status, State state);
/// Adds an event about a robot's command.
void reportCommand(const Scene& world, EventLog& log, Event::Kind kind, int robot,
                   const std::string& other, const std::string& text);
/// Puts the robot into that phase, and reports it.
void enterPhase(TaskView& world, int robot, Phase phase, Status status, State state);

}  // namespace kiva
