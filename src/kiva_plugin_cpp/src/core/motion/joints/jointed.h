// SPDX-License-Identifier: Apache-2.0
//
// The reference drive model: a chassis on two jointed, motorised wheels and casters, with rigid
// contacts and Coulomb friction at the floor. Each robot is a small system of its own with eight
// degrees of freedom: the chassis' six and the wheels' two. The choice of coordinates keeps the
// wheel joints exact (Featherstone 2008, chapter 3). Motors and contacts are solved as impulses of
// a step (Stewart and Trinkle 1996). Contacts with other models are Bullet's, which moves a robot
// in the plane like one of the traction drive.
#pragma once

#include "core/motion/wheels/vehicle.h"
#include "core/state/views/robot_view.h"

namespace kiva {

/// Changes velocities and wheel speeds of the robot by one step of gravity, motors and floor;
/// positions stay.
void driveJointed(RobotView& world, int robot);
/// Returns the vehicle of a jointed robot. Casters ahead of and behind the axle bear a part of the
/// weight, and more of it when the robot accelerates or brakes.
Vehicle jointedVehicle(const Scene& world, int robot, const Ground& ground);

/// Moves the chassis vertically, in roll and in pitch by one step, after its planar motion.
void settleJointed(RobotView& world, int robot);
/// Ends the rocking of a standing chassis if it is small enough. Returns whether it was.
bool restJointed(FleetState& fleet, int robot);

}  // namespace kiva
