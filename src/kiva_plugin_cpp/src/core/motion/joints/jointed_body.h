// SPDX-License-Identifier: Apache-2.0
//
// A robot of the jointed drive as a mechanism: a chassis with its load, on which two wheels spin.
#pragma once

#include <vector>

#include "core/physics/bodies/spatial_inertia.h"
#include "core/state/views/motion_view.h"

namespace kiva {

/// What does not change while tower and load stay. In the chassis frame: the model's, but with its
/// origin raised to the height of the axle.
struct JointedBody {
  struct Wheel {
    btVector3 centre;
    double radius;    ///< [m]
    double friction;  ///< Coulomb coefficient.
  };
  /// A ball of the chassis that may touch the floor: a caster, or with radius 0 a corner.
  struct Foot {
    btVector3 centre;
    double radius;
    double friction;
  };
  /// How turning (x, y, z) [rad/s] and the wheels' spins [rad/s] answer to angular impulses about
  /// the centre and to impulses of spin [Nm s].
  using Response = double[5][5];

  double axle_height;  ///< The chassis frame's height over the model's [m].
  btVector3 axle;      ///< Unit vector; wheels spin about it.
  Wheel wheels[2];     ///< Left, right.
  std::vector<Foot> feet;
  double low_feet_reach;  ///< What is not a low foot stays off the floor up to that sine of a tilt,
  int low_feet = 0;       ///< the first ones of `feet`.
  double spring_share;    ///< Share of the weight that each caster's spring bears.
  double front_reach;     ///< The foremost low foot's, ahead of the axle [m].
  double rear_reach;      ///< The last one's, behind the axle [m].

  double inverse_mass;   ///< With load and wheels [1/kg].
  btVector3 centre;      ///< The centre of mass.
  btMatrix3x3 inertia;   ///< About the centre, without the wheels' about their axle [kg m²].
  double spin_inertia;   ///< Moment of one wheel with its motor about the axle [kg m²].
  Response response[4];  ///< Bit i of the index: wheel i spins freely, and is not held.

  // What the mechanism was made for.
  double tower = -1;
  int unit = -1;
  double load_mass = 0, load_inertia = 0;
  SpatialInertia load;  ///< In the unit's frame.
};

/// Returns a storage unit with its items, in its frame.
SpatialInertia sumUnit(const Scene& world, int unit);

/// Returns the Coulomb coefficient of the tyre of a wheel's link: its first round shape.
double tyreFriction(const Link& wheel);

/// Returns whether a model has the links `left_wheel` and `right_wheel`, which the drive needs.
bool hasDriveWheels(const ModelDescription& model);

/// Returns the robot's mechanism with its present load and tower. Throws DescriptionError if it
/// lacks a link `left_wheel` or `right_wheel`.
const JointedBody& jointedBody(MotionView& world, int robot);

}  // namespace kiva
