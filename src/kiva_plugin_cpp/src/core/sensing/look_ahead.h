// SPDX-License-Identifier: Apache-2.0
//
// What lies in a robot's way, as its laser sees it.
#pragma once

#include "core/state/world_state.h"

namespace kiva {

/// After a step: robots that drive and whose scan is due look ahead, as do those that begin to
/// drive. Task::sighting says what they saw, WorldState::sighted who they are.
void lookAhead(WorldState& world);

/// How far along its segment something is in the robot's way: on a path up to what it takes to
/// stand at the end of the run as it is released [m]; +inf = wherever it is.
double reachOfInterest(const WorldState& world, int robot);

}  // namespace kiva
