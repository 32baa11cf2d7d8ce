// SPDX-License-Identifier: Apache-2.0
//
// A robot of the jointed drive as a mechanism: a chassis with its load, and two wheels on it.
#pragma once

#include <vector>

#include "core/physics/bodies/spatial_inertia.h"
#include "core/state/views/scene.h"

namespace kiva {

/// The constants of the mechanism while tower and load stay. In the chassis frame: the model's
/// frame with its origin raised to the height of the axle.
struct JointedBody {
  struct Wheel {
    btVector3 centre;
    double radius;    ///< [m]
    double friction;  ///< Coulomb coefficient.
  };
  /// A ball of the chassis that may touch the floor: a caster, or a corner with radius 0.
  struct Foot {
    btVector3 centre;
    double radius;
    double friction;
  };
  /// Change of the angular velocity (x, y, z) and of the wheels' speeds [rad/s] by angular impulses
  /// about the centre and impulses on the wheels [Nm s].
  using Response = double[5][5];

  double axle_height;  ///< Height of the chassis frame above the model's frame [m].
  btVector3 axle;      ///< Unit vector; wheels spin about it.
  Wheel wheels[2];     ///< Left, right.
  std::vector<Foot> feet;
  double low_feet_reach;  ///< Sine of the tilt up to which all feet but the low ones stay off the
                          ///< floor.
  int low_feet = 0;       ///< Count of low feet, the first ones of `feet`.
  double spring_share;    ///< Share of the weight that each caster's spring bears.
  double front_reach;     ///< Distance of the foremost low foot ahead of the axle [m].
  double rear_reach;      ///< Distance of the rearmost low foot behind the axle [m].

  double inverse_mass;  ///< Inverse of the mass with load and wheels [1/kg].
  btVector3 centre;     ///< The centre of mass.
  btMatrix3x3 inertia;  ///< Inertia about the centre, without the wheels' about their axle [kg m²].
  double spin_inertia;   ///< Moment of one wheel with its motor about the axle [kg m²].
  Response response[4];  ///< Bit i of the index: wheel i spins freely; otherwise it is held.

  // The state of tower and load for which this was made.
  double tower = -1;
  int unit = -1;
  double load_mass = 0, load_inertia = 0;
  SpatialInertia load;  ///< The load, in the unit's frame.
};

/// Returns the inertia of a storage unit with its items, in its frame.
SpatialInertia sumUnit(const Scene& world, int unit);

/// Returns the Coulomb coefficient of the tyre of a wheel's link, its first round shape.
double tyreFriction(const Link& wheel);

/// Returns whether a model has the links `left_wheel` and `right_wheel`, which the drive needs.
bool hasDriveWheels(const ModelDescription& model);

/// Returns the robot's mechanism with its present load and tower. Throws DescriptionError if a link
/// `left_wheel` or `right_wheel` is missing.
const JointedBody& jointedBody(const Scene& world, int robot);

}  // namespace kiva
