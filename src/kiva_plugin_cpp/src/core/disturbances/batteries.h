// SPDX-License-Identifier: Apache-2.0
//
// Drains and charges the robots' batteries; does nothing while the world's realism has no energy.
#pragma once

#include "core/state/floor/chargers.h"
#include "core/state/views/motion_view.h"

namespace kiva {

/// Accounts for motion and lifting at each step, and for electronics, rolling and charging ten
/// times a second. A robot stops when its battery is empty.
void updateBatteries(MotionView& world, Chargers& chargers);
/// Replaces an empty battery by a full one; the robot goes on.
void swapBattery(MotionView& world, int robot);
/// Derives the charge that robots show from their batteries, after a checkpoint was read.
void restoreCharge(FleetState& fleet, const EnergyRealism& realism);

}  // namespace kiva
