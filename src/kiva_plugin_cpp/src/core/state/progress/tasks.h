// SPDX-License-Identifier: Apache-2.0
//
// Changes the phases of robots: a command begins and goes through its segments, until it is done or
// blocked.
#pragma once

#include <deque>
#include <string>

#include "core/state/views/motion_view.h"

namespace kiva {

/// Begins the segments of the command that the robot's task names. None: it is done already.
void beginTask(MotionView& world, int robot, std::deque<MotionSegment> segments);
/// Begins a path; `segments` bring the robot to its point 0.
void beginPath(MotionView& world, int robot, std::uint32_t id, ReleasedPath path,
               std::deque<MotionSegment> segments);
/// Continues a path on one of its points, at the end of a run or of a turn: the robot turns,
/// drives, waits for a release, or is done.
void continuePath(MotionView& world, int robot);
/// Lets a robot that brakes or stands on its path go on, since its way is free again.
void resumePath(MotionView& world, int robot);
/// Begins the robot's first segment at the next step, unless it is stopped.
void startSegment(MotionView& world, int robot);
/// Ends the current segment: the next one begins, or the command is DONE, or BLOCKED if it was
/// stopping.
void finishSegment(MotionView& world, int robot);
/// Ends the command in BLOCKED as soon as the robot has done what `phase` says: kBraking, kHalting
/// or kAbandoning. The robot reports BLOCKED from now on; the first of several reasons counts.
void stopTask(MotionView& world, int robot, Phase phase, const std::string& by,
              const std::string& reason);
/// Ends a stop: BLOCKED, then idle.
void endStop(MotionView& world, int robot);
/// Ends the command as done, or as cancelled.
void endDone(MotionView& world, int robot);
/// Ends the command in BLOCKED at once, in any phase.
void endBlocked(MotionView& world, int robot, const std::string& by, const std::string& reason);
/// Locks the wheels of a robot that turns or drives, at once; one that lifts stands anyway, and a
/// path on which it stands is over.
void haltRobot(MotionView& world, int robot, const std::string& by, const std::string& reason);
/// Sets what the robot reports, and records it if it is new.
void setStatus(MotionView& world, int robot, Status status, State state);
/// Reports what became of a robot's command.
void reportCommand(MotionView& world, Event::Kind kind, int robot, const std::string& other,
                   const std::string& text);
/// Puts the robot into that phase, and reports so.
void enterPhase(MotionView& world, int robot, Phase phase, Status status, State state);

}  // namespace kiva
