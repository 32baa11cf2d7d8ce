// SPDX-License-Identifier: Apache-2.0
//
// Looks for obstacles in a robot's way, as its laser sees them.
#pragma once

#include "core/state/robots/scans.h"
#include "core/state/views/robot_view.h"

namespace kiva {

/// Looks ahead after a step, for driving robots whose scan is due and for robots that begin to
/// drive. Fills Task::sighting, and Scans::sighted with their indices.
void lookAhead(RobotView& world, Scans& scans);

/// Returns the distance along its segment up to which an obstacle is in the robot's way [m]; +inf =
/// at any distance. On a path it is the room to stand at the released end of the run.
double reachOfInterest(const Scene& world, int robot);

}  // namespace kiva
