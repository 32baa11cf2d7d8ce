// SPDX-License-Identifier: Apache-2.0
//
// Estimates a robot's pose by the odometry of its wheels, corrected by the codes on the floor. An
// extended Kalman filter also estimates the wheels' radii (Martinelli and Siegwart 2003).
#pragma once

#include <cstdint>

namespace kiva {

/// A pose in world [m, rad]; yaw unwrapped.
struct PlanarPose {
  double x = 0, y = 0, yaw = 0;
};

/// Sizes of a differential drive, left wheel first [m].
struct DriveSizes {
  double radius[2] = {0.1, 0.1};
  double separation = 0.52;
};

/// A part of a cruise, on which the robot believes to drive an arc or to turn in place. A unit of
/// its reference is a metre of the arc, or a radian.
struct Stretch {
  bool under_way = false;
  bool turns = false;         ///< It turns in place.
  double from = 0;            ///< Reference at its beginning,
  double until = 0;           ///< and at its end.
  double curvature = 0;       ///< Curvature to the left [1/m].
  double next_curvature = 0;  ///< The next arc's curvature,
  double next_length = 0;     ///< and its length [m]; 0 = none.
};

struct Localisation {
  static constexpr int kStates = 5;  ///< x, y, yaw, and the remaining errors of the two radii.

  PlanarPose pose;  ///< Believed pose; during a stretch, that at its beginning.
  DriveSizes believed;
  double covariance[kStates * kStates] = {};  ///< Covariance at its last propagation.
  double way = 0, turn = 0;                   ///< Believed way and turn since then [m, rad].
  double wheel_angle[2] = {0, 0};  ///< Angles whose rolling is included in the pose [rad].
  double slip[2] = {0, 0};         ///< Present slip of the wheels, as a share of their way.
  double slip_for = 0;             ///< Distance for which the slip stays [m].
  double since_code = 0;           ///< Way since the last code that it read [m].
  double lost_at = 0;              ///< Value of since_code at which it is lost next [m].
  bool lost = false;
  std::int32_t code_column = 0, code_row = 0;  ///< The last code that it passed, read or not.
  std::uint32_t draws = 0;                     ///< Random numbers drawn so far.
  Stretch stretch;

  /// Returns the believed pose; during a stretch, that at `reference`.
  PlanarPose at(double reference) const;
  /// Ends the stretch, if one is under way, so that `pose` is the present one.
  void settle(double reference, double left_angle, double right_angle);
  /// Adds the odometry of the wheels since the last call. Returns the way of the robot's middle
  /// [m], >= 0.
  double roll(double left_angle, double right_angle);
  /// Adds the uncertainty of the motion since the last call. Deviations: `slip` of a wheel over a
  /// metre, `separation` as a share.
  void propagate(double slip, double separation);
  /// Computes forward speed [m/s] and turn rate [rad/s] from the wheels' rates [rad/s], and their
  /// covariance, row by row. A wheel's slip is constant over `slip_length` [m].
  void measure(const double rates[2], double slip, double slip_length, double separation,
               double speeds[2], double variances[4]) const;
  /// Corrects pose and radii by a code's reading. Deviations in [m, rad].
  void correct(const PlanarPose& reading, double position_noise, double angle_noise);
};

}  // namespace kiva
