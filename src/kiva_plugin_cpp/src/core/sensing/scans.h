// SPDX-License-Identifier: Apache-2.0
//
// The robots' lasers: the schedule and the results of scans.
#pragma once

#include "core/state/robots/failure_state.h"
#include "core/state/robots/scans.h"
#include "core/state/views/scene.h"

namespace kiva {

/// Returns the number of steps between two scans of a robot.
std::uint64_t scanPeriod(const Clock& clock, const Robot& robot);
/// Fills Scans::due with the robots whose scans are due at this step, in the fleet's order. The
/// fleet's scans are spread over the period.
void findDueScans(const Scene& world, const FailureState& failures, Scans& scans);

/// Returns whether its laser is broken.
bool isBlind(const FleetState& fleet, int robot);

/// Gives the robot the directions of its laser's rays, shared with others of the same kind.
void setRays(Scans& scans, Robot* robot);

/// Returns the directions of that many rays between two angles to the heading [rad].
RayFan fanOf(int rays, double min_angle, double max_angle);

Sensor sensorOf(const Scene& world, int robot);

/// Casts the robot's rays, with noise if the realism has it.
void castRays(const Scene& world, const Scans& scans, int robot, const FanReach& reach,
              FanHits* hits);

}  // namespace kiva
