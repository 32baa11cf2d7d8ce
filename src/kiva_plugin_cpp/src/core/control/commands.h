// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/state/world_state.h"

namespace kiva {

/// Answers all queued commands, and gives the accepted ones to their robots.
void acceptCommands(WorldState& world);
/// The current segment is over: the next one, or DONE.
void finishSegment(WorldState& world, int robot);
/// The command ends now: BLOCKED, then idle.
void endBlocked(WorldState& world, int robot);
/// The command is to end as soon as the robot stands: it reports BLOCKED from now on.
void markBlocked(WorldState& world, int robot, const std::string& by, const std::string& reason);
/// The same with locked wheels, at once.
void haltRobot(WorldState& world, int robot, const std::string& by, const std::string& reason);
/// Drops the command without an end, as for a robot that is deleted or reset.
void clearCommand(WorldState& world, int robot);

/// Wraps to (-pi, pi].
double wrapAngle(double angle);

}  // namespace kiva
