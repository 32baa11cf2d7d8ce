// SPDX-License-Identifier: Apache-2.0
//
// How a robot's phase changes: a command begins and goes through its segments, until it is done or
// blocked.
#pragma once

#include <deque>
#include <string>

#include "core/state/motion_view.h"

namespace kiva {

/// The robot, whose task names the command, is at these from now on. None: it is done already.
void beginTask(MotionView& world, int robot, std::deque<MotionSegment> segments);
/// The same with a path; `segments` bring the robot to its point 0.
void beginPath(MotionView& world, int robot, std::uint32_t id, ReleasedPath path,
               std::deque<MotionSegment> segments);
/// The robot stands on a point of its path, at the end of a run or of a turn: it turns, drives,
/// waits for a release, or is done.
void continuePath(MotionView& world, int robot);
/// The way is free again before a robot that brakes or stands on its path: it goes on.
void resumePath(MotionView& world, int robot);
/// It begins the first of its segments at the next step, unless it is stopped.
void startSegment(MotionView& world, int robot);
/// The current segment is over: the next one, or DONE; BLOCKED if the command was stopping.
void finishSegment(MotionView& world, int robot);
/// The command is to end in BLOCKED as soon as the robot has done what `phase` says: kBraking,
/// kHalting or kAbandoning. It reports BLOCKED from now on; of several reasons the first counts.
void stopTask(MotionView& world, int robot, Phase phase, const std::string& by,
              const std::string& reason);
/// The stop is over: BLOCKED, then idle.
void endStop(MotionView& world, int robot);
/// The command is done; or cancelled, if it was.
void endDone(MotionView& world, int robot);
/// The command ends in BLOCKED now, whatever the robot is at.
void endBlocked(MotionView& world, int robot, const std::string& by, const std::string& reason);
/// Locks the wheels of a robot that turns or drives, at once; one that lifts stands anyway, and a
/// path on which it stands is over.
void haltRobot(MotionView& world, int robot, const std::string& by, const std::string& reason);
/// Sets what the robot reports, and records it if it is new.
void setStatus(MotionView& world, int robot, Status status, State state);
/// Reports what became of a robot's command.
void reportCommand(MotionView& world, Event::Kind kind, int robot, const std::string& other,
                   const std::string& text);
/// The robot is in that phase from now on, and reports so.
void enterPhase(MotionView& world, int robot, Phase phase, Status status, State state);

}  // namespace kiva
