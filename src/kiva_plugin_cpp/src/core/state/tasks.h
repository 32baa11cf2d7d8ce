// SPDX-License-Identifier: Apache-2.0
//
// How a robot's phase changes: a command begins and goes through its segments, until it is done or
// blocked.
#pragma once

#include <deque>
#include <string>

#include "core/state/world_state.h"

namespace kiva {

/// The robot, whose task names the command, is at these from now on. None: it is done already.
void beginTask(WorldState& world, int robot, std::deque<MotionSegment> segments);
/// The current segment is over: the next one, or DONE; BLOCKED if the command was stopping.
void finishSegment(WorldState& world, int robot);
/// The command is to end in BLOCKED as soon as the robot has done what `phase` says: kBraking,
/// kHalting or kAbandoning. It reports BLOCKED from now on; of several reasons the first counts.
void stopTask(WorldState& world, int robot, Phase phase, const std::string& by,
              const std::string& reason);
/// The stop is over: BLOCKED, then idle.
void endStop(WorldState& world, int robot);
/// The command ends in BLOCKED now, whatever the robot is at.
void endBlocked(WorldState& world, int robot, const std::string& by, const std::string& reason);
/// Locks the wheels of a robot that turns or drives, at once; one that lifts stands anyway.
void haltRobot(WorldState& world, int robot, const std::string& by, const std::string& reason);

}  // namespace kiva
