// SPDX-License-Identifier: Apache-2.0
//
// What robots take from their batteries, and where those are charged; nothing while the world's
// realism has no energy.
#pragma once

#include "core/state/world_state.h"

namespace kiva {

/// Ten times a second: what was used and taken up since the last time. A robot whose battery is
/// empty stands from then on.
void useEnergy(WorldState& world);
/// An empty battery becomes a full one; the robot goes on.
void exchangeBattery(WorldState& world, int robot);
/// Robots of a world that was read show the charge that their batteries have.
void markCharge(WorldState& world);

}  // namespace kiva
