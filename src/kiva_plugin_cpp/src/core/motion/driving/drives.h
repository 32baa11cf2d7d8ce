// SPDX-License-Identifier: Apache-2.0
//
// What is asked of either drive model: the floor it stands on, and what its robot can be asked for.
#pragma once

#include "core/motion/wheels/vehicle.h"
#include "core/state/views/motion_view.h"

namespace kiva {

/// From the robot's origin to the centre of mass of all that is it, along the world's axes [m].
Vector3 centreFromOrigin(const Fleet& fleet, int robot);

/// Returns a robot as it knows itself and its load, to plan by: on a floor that its wheels grip as
/// its drive's parameters say, with a reserve to mend errors with.
Vehicle plannedVehicle(MotionView& world, int robot);

/// Returns what a robot that knows its load asks of itself at most so that it does not tip [m/s²];
/// +inf without a load, or where loads are ideal.
double loadLimit(const Scene& world, int robot);

/// Returns what speeding up and braking are planned with, as far as motors and wheels can with that
/// load [m/s²]; 0 = at once.
double plannedAcceleration(MotionView& world, int robot);
/// Returns the deceleration for an obstacle's sake, at least as hard.
double plannedBraking(MotionView& world, int robot);

}  // namespace kiva
