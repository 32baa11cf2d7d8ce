// SPDX-License-Identifier: Apache-2.0
//
// The reference drive model: a chassis on two jointed, motorised wheels and casters, with rigid
// contacts and Coulomb friction at the floor. Each robot is a small system of its own, in eight
// degrees of freedom: the chassis' six and the wheels' spins. The wheel joints hold by the choice
// of coordinates (Featherstone 2008, chapter 3); motors and contacts are solved for as impulses of
// a step (Stewart and Trinkle 1996). Robots and other things touch each other in Bullet, which
// moves a robot in the plane as one of the traction drive.
#pragma once

#include "core/motion/wheels/vehicle.h"
#include "core/state/views/motion_view.h"

namespace kiva {

/// Changes velocities and wheel speeds of robot `i` by one step's gravity, motors and floor;
/// positions stay.
void driveJointed(MotionView& world, int robot);
/// Returns the vehicle that a jointed robot is: casters ahead of and behind the axle bear a part of
/// the weight, and more of it when the robot speeds up or brakes.
Vehicle jointedVehicle(MotionView& world, int robot, const Ground& ground);

/// Moves the chassis up, down and about by one step; its place in the plane has been found.
void settleJointed(MotionView& world, int robot);
/// Ends the last of a standing chassis' rocking. Returns whether it is little enough for that.
bool restJointed(FleetState& fleet, int robot);

}  // namespace kiva
