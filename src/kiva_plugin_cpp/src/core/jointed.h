// SPDX-License-Identifier: Apache-2.0
//
// The reference drive model: a chassis on two hinged, motorised wheels and frictionless casters,
// all of it Bullet's.
#pragma once

#include "parts.h"

namespace kiva {

/// Bodies of the robot with its present load: chassis (with tower and load), left and right wheel.
ModelBodies buildJointed(const Parts& parts, int robot);
/// Asks the hinges' motors for the wheel targets; the step does the rest.
void driveJointed(Parts& parts, int robot);
/// Reads pose, velocity and wheel speeds back into the fleet.
void readJointed(Parts& parts, int robot);

}  // namespace kiva
