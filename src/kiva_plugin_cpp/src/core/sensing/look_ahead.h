// SPDX-License-Identifier: Apache-2.0
//
// Finds what lies in a robot's way, as its laser sees it.
#pragma once

#include "core/state/robots/scans.h"
#include "core/state/views/motion_view.h"

namespace kiva {

/// Lets robots look ahead after a step: those that drive and whose scan is due, and those that
/// begin to drive. Fills Task::sighting, and Scans::sighted with their indices.
void lookAhead(MotionView& world, Scans& scans);

/// Returns how far along its segment something is in the robot's way: on a path up to what it takes
/// to stand at the end of the run as it is released [m]; +inf = wherever it is.
double reachOfInterest(const Scene& world, int robot);

}  // namespace kiva
