// SPDX-License-Identifier: Apache-2.0
//
// A robot with its load as its motors move it, and the accelerations that motors can give and
// wheels can hold without slip.
#pragma once

#include <algorithm>
#include <limits>

#include "kiva_plugin_cpp/fleet.h"

namespace kiva {

constexpr double kUnlimited = std::numeric_limits<double>::infinity();

/// The ground under a robot.
struct Ground {
  double gravity = 9.81;        ///< [m/s²]
  double friction[2] = {1, 1};  ///< Coulomb coefficient of its surface under each wheel.
};

/// A robot with its load in the chassis frame, wheels upright on the floor; index 0 is the left
/// wheel.
struct Vehicle {
  double mass;             ///< [kg]
  double inertia;          ///< About z through the centre of mass [kg m²].
  double centre[2];        ///< Position of the centre of mass [m].
  double radius;           ///< Radius of a wheel [m].
  double half_separation;  ///< Half of the distance between the wheels [m].
  double wheel_inertia;    ///< Moment of one wheel with its motor about the axle [kg m²].
  double torque;           ///< Limit of one motor [Nm].
  double grip[2];          ///< Largest friction force of each wheel at rest [N].
  double friction[2];      ///< Coulomb coefficient of each wheel on this ground.
  /// Load that an acceleration takes off the wheels, per mass and acceleration: half of it off each
  /// wheel when it accelerates or brakes, off the inner wheel for sideways accelerations.
  double lift_ahead = 0, lift_braking = 0, lift_sideways = 0;

  /// Returns each wheel's share of a force along the heading without yaw, which is also its share
  /// of the weight if the wheels bear all of it.
  double share(int wheel) const {
    const double aside = centre[1] / (2 * half_separation);
    return wheel == 0 ? 0.5 + aside : 0.5 - aside;
  }
  /// Returns a wheel's share of the weight if the wheels bear `on_wheels` of it, and casters in the
  /// middle the rest.
  double weight(int wheel, double on_wheels) const {
    return std::max(0.0, share(wheel) - (1 - on_wheels) / 2);
  }
};

/// Returns the Coulomb coefficient between a wheel and the ground: the smallest of the drive's, the
/// tyre's and the ground's.
double wheelFriction(const Robot& robot, int wheel, const Ground& ground);

/// Returns the vehicle of the traction drive, whose weight stays where it is.
Vehicle vehicleOf(const Robot& robot, const Ground& ground);

/// Returns the acceleration, in any direction, from which a robot's load tips [m/s²]; +inf without
/// a load.
double tippingAcceleration(const Robot& robot, double gravity);

/// Returns the largest acceleration along the heading [m/s²].
double drivingLimit(const Vehicle& vehicle);
/// Returns the largest deceleration along the heading [m/s²]; a robot that brakes harder slides.
double brakingLimit(const Vehicle& vehicle);

/// Returns the largest acceleration [rad/s²] of a turn in place about the middle of the axle. The
/// turn goes from rest to rest over `angle` [rad], the first half at that acceleration, the second
/// at minus that.
double turningLimit(const Vehicle& vehicle, double angle);
/// Returns the share of the motors' and wheels' limits that such a turn takes at an acceleration
/// [rad/s²] and a speed [rad/s]: a load off the centre also has to be held on its circle.
double turningEffort(const Vehicle& vehicle, double acceleration, double speed);

}  // namespace kiva
