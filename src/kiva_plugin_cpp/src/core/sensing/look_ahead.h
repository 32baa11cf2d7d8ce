// SPDX-License-Identifier: Apache-2.0
//
// What lies in a robot's way, as its laser sees it.
#pragma once

#include "core/state/world_state.h"

namespace kiva {

/// After a step: robots that drive and whose scan is due look ahead, as do those that begin to
/// drive. Task::sighting says what they saw, WorldState::sighted who they are.
void lookAhead(WorldState& world);

/// Whether the robot, standing or turning at (x, y), would touch anything.
bool isFree(const WorldState& world, int robot, double x, double y);

/// Along its segment, 0 at the end and negative before it [m].
double alongSegment(const FleetState& fleet, int robot);

}  // namespace kiva
