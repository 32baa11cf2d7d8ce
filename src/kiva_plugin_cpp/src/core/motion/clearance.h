// SPDX-License-Identifier: Apache-2.0
//
// Whether a robot, wherever it may go within a short time, can come near anything. A robot looks
// again whenever it begins to move otherwise, so that one that stands need not be reckoned with as
// if it moved.
#pragma once

#include "core/state/world_state.h"

namespace kiva {

/// Nearer than that Bullet decides [m]; less than what is between two that turn in adjacent cells.
constexpr double kNear = 0.004;

/// The robot with its load as one upright box, in world.
Footprint footprintOf(const Fleet& fleet, int robot);
/// The circle that holds it however it turns.
Footprint turned(Footprint geometry);
/// What it covers while it goes by (dx, dy) [m] along its heading.
Footprint moved(Footprint geometry, double dx, double dy);

/// Whether nothing comes near the ground `swept`, which the robot covers within `time` [s].
bool isClear(const WorldState& world, int robot, const Footprint& swept, double time);

}  // namespace kiva
