// SPDX-License-Identifier: Apache-2.0
//
// The robots' lasers: when they scan, and what they see.
#pragma once

#include "core/geometry/ray_fan.h"
#include "core/state/world_state.h"

namespace kiva {

/// Steps between two scans of a robot.
std::uint64_t scanPeriod(const WorldState& world, const Robot& robot);
/// Fills WorldState::scans_due: whose lasers turn in a scan at this step, in the fleet's order. The
/// fleet's scans are spread over the period.
void findDueScans(WorldState& world);

/// Whether its laser is broken.
bool isBlind(const WorldState& world, int robot);

/// Gives the robot the directions of its laser's rays, shared with others of the same kind.
void setRays(WorldState& world, Robot* robot);

Sensor sensorOf(const WorldState& world, int robot);

/// Casts the robot's rays; as far as lasers are real, with their noise.
void castRays(const WorldState& world, int robot, const FanReach& reach, FanHits* hits);

}  // namespace kiva
