// SPDX-License-Identifier: Apache-2.0
//
// What lies in a robot's way, as its laser sees it.
#pragma once

#include "core/state/motion_view.h"
#include "core/state/scans.h"

namespace kiva {

/// After a step: robots that drive and whose scan is due look ahead, as do those that begin to
/// drive. Task::sighting says what they saw, Scans::sighted who they are.
void lookAhead(MotionView& world, Scans& scans);

/// How far along its segment something is in the robot's way: on a path up to what it takes to
/// stand at the end of the run as it is released [m]; +inf = wherever it is.
double reachOfInterest(const Scene& world, int robot);

}  // namespace kiva
