// SPDX-License-Identifier: Apache-2.0
//
// The way of what robots report to who listens: at once, or as a radio brings it, late or not at
// all.
#pragma once

#include "core/state/world_state.h"

namespace kiva {

/// What the robot would report now.
RobotReport reportOf(const WorldState& world, int robot);
/// Robots report ten times a second, and when their status changes; takes in what has come by now.
/// Nothing while the world's realism has no radio.
void exchangeReports(WorldState& world);
/// Whoever has put a robot somewhere knows where it is, heard or not.
void knowWhereabouts(WorldState& world, int robot);

}  // namespace kiva
