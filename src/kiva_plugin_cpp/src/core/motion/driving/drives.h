// SPDX-License-Identifier: Apache-2.0
//
// Limits of plans for robots of either drive model: accelerations with their load on the floor.
#pragma once

#include "core/motion/wheels/vehicle.h"
#include "core/state/views/scene.h"

namespace kiva {

/// Returns the vector from the robot's origin to its centre of mass, along the world's axes [m].
Vector3 centreFromOrigin(const Fleet& fleet, int robot);

/// Returns the vehicle for plans: the robot with its load, on a floor with the friction of its
/// drive's parameters, less a reserve for corrections.
Vehicle plannedVehicle(const Scene& world, int robot);

/// Returns the largest acceleration at which a robot's load does not tip [m/s²]; +inf without a
/// load, or where loads are ideal.
double loadLimit(const Scene& world, int robot);

/// Returns the acceleration of planned drives [m/s²], within the limits of motors and wheels under
/// the load; 0 = at once.
double plannedAcceleration(const Scene& world, int robot);
/// Returns the deceleration before obstacles, at least as large [m/s²].
double plannedBraking(const Scene& world, int robot);

}  // namespace kiva
