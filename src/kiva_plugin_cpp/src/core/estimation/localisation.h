// SPDX-License-Identifier: Apache-2.0
//
// Estimates a robot's pose: odometry of its wheels, corrected by the codes on the floor in an
// extended Kalman filter that learns the wheels' radii on the way (Martinelli and Siegwart 2003).
#pragma once

#include <cstdint>

namespace kiva {

/// In world [m, rad]; yaw unwrapped.
struct PlanarPose {
  double x = 0, y = 0, yaw = 0;
};

/// Sizes of a differential drive, left wheel first [m].
struct DriveSizes {
  double radius[2] = {0.1, 0.1};
  double separation = 0.52;
};

/// Part of a cruise on which the robot believes to drive an arc, or to turn in place. A unit of its
/// reference is a metre of the arc, or a radian.
struct Stretch {
  bool under_way = false;
  bool turns = false;         ///< In place.
  double from = 0;            ///< Reference at its beginning,
  double until = 0;           ///< and at its end.
  double curvature = 0;       ///< To the left [1/m].
  double next_curvature = 0;  ///< The next arc's curvature,
  double next_length = 0;     ///< and its length [m]; 0 = none.
};

struct Localisation {
  static constexpr int kStates = 5;  ///< x, y, yaw, and what is left of the radii's errors.

  PlanarPose pose;  ///< Believed; while a stretch is under way, that at its beginning.
  DriveSizes believed;
  double covariance[kStates * kStates] = {};  ///< When it was last propagated.
  double way = 0, turn = 0;                   ///< Believed to have gone since then [m, rad].
  double wheel_angle[2] = {0, 0};             ///< Up to which the wheels' way is in the pose [rad].
  double slip[2] = {0, 0};                    ///< The wheels' slip now, as a share of their way.
  double slip_for = 0;                        ///< [m] for which it stays so.
  double since_code = 0;                      ///< Way since the last code that it read [m].
  double lost_at = 0;                         ///< [m] of that at which it is lost next.
  bool lost = false;
  std::int32_t code_column = 0, code_row = 0;  ///< The last code that it passed, read or not.
  std::uint32_t draws = 0;                     ///< Random numbers drawn so far.
  Stretch stretch;

  /// Returns where it believes to be, its reference being there if a stretch is under way.
  PlanarPose at(double reference) const;
  /// Ends the stretch, if one is under way: the pose is that of now.
  void settle(double reference, double left_angle, double right_angle);
  /// Odometry: adds what the wheels have turned since then. Returns the way of the middle [m], >=
  /// 0.
  double roll(double left_angle, double right_angle);
  /// What has gone since the last time makes the pose less certain. Deviations: `slip` of a wheel
  /// over a metre, `separation` as a share.
  void propagate(double slip, double separation);
  /// Speed ahead [m/s] and turn rate [rad/s] by the wheels' rates [rad/s], and their covariance,
  /// row by row, where the wheels slip alike for `slip_length` [m].
  void measure(const double rates[2], double slip, double slip_length, double separation,
               double speeds[2], double variances[4]) const;
  /// A code was read: corrects pose and radii. Deviations in [m, rad].
  void correct(const PlanarPose& reading, double position_noise, double angle_noise);
};

}  // namespace kiva
