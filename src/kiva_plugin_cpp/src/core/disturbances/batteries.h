// SPDX-License-Identifier: Apache-2.0
//
// What robots take from their batteries, and where those are charged; nothing while the world's
// realism has no energy.
#pragma once

#include "core/state/chargers.h"
#include "core/state/motion_view.h"

namespace kiva {

/// At each step what motion and lifting take, ten times a second what electronics and rolling take
/// and chargers give. A robot whose battery is empty stands from then on.
void useEnergy(MotionView& world, Chargers& chargers);
/// An empty battery becomes a full one; the robot goes on.
void exchangeBattery(MotionView& world, int robot);
/// Robots of a world that was read show the charge that their batteries have.
void markCharge(FleetState& fleet, const EnergyRealism& realism);

}  // namespace kiva
