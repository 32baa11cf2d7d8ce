// SPDX-License-Identifier: Apache-2.0
//
// Speed limits of a path's ways, from point to point. A limit holds while the robot's centre is
// between the two points: it has slowed down where the way begins, and accelerates where it ends.
#pragma once

#include "core/state/views/scene.h"

namespace kiva {

/// Returns the highest speed of the next step [m/s]: that of the present way, and on the way down
/// to slower ways ahead; +inf = no limit.
double permittedSpeed(const Scene& world, int robot);

/// Returns the reference up to which the robot's limits allow `top_speed`, and no more [m]; +inf =
/// to the end of its run.
double holdsUntil(const Scene& world, int robot, double top_speed);

/// Returns whether the robot may drive at up to `top_speed` for more than a step.
bool holdsSpeed(const Scene& world, int robot, double top_speed);

}  // namespace kiva
