// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace kiva {

/// A reference that moves to a target with limited speed and acceleration and stops there.
/// The target and the deceleration may change at any step, so that a robot can stop earlier than
/// planned. Positions and speeds are along one axis, in [m, m/s] or [rad, rad/s].
struct Profile {
  double position = 0;
  double speed = 0;

  /// Largest distance from the target that counts as rounding.
  static constexpr double kThere = 1e-12;

  /// Advances by a step of `dt` towards `target`. `acceleration` 0: full speed, and rest, at once.
  /// `deceleration` is that of the run's end.
  void advance(double target, double top_speed, double acceleration, double deceleration,
               double dt) {
    const double distance = std::abs(target - position);
    const double sign = target < position ? -1.0 : 1.0;
    const double forward = sign * speed;
    const double braked =
        larger(stoppingSpeed(distance, deceleration, dt), forward - deceleration * dt);
    const double ramped = smaller(smaller(top_speed, forward + acceleration * dt), braked);
    const double target_speed = larger(acceleration > 0.0 ? ramped : top_speed, 0.0);
    const double next = smaller(target_speed, distance * (1 / dt));
    const double moved = position + sign * next * dt;
    speed = sign * next;
    position = distance - next * dt <= kThere ? target : moved;
  }

  /// Advances by a step of `dt` towards a stop after v²/(2 deceleration), for any step size;
  /// deceleration 0: rest at once. `stop_at` is the position of the stop, which the first step sets
  /// if it is kNowhere.
  void brake(double deceleration, double dt, double* stop_at) {
    if (deceleration == 0) {
      speed = 0;
      return;
    }
    if (*stop_at == kNowhere) *stop_at = position + speed * std::abs(speed) / (2 * deceleration);
    advance(*stop_at, std::abs(speed), deceleration, deceleration, dt);
  }

  static constexpr double kNowhere = std::numeric_limits<double>::infinity();

  bool reached(double target) const { return position == target; }

  /// Returns whether it can still stop at `target`, ahead of it along the axis, at that
  /// deceleration; 0: at once.
  bool canStopAt(double target, double deceleration, double dt) const {
    const double distance = target - position;
    if (distance < -kThere) return false;
    if (deceleration == 0 || speed <= 0) return true;
    return speed - deceleration * dt <= stoppingSpeed(std::max(0.0, distance), deceleration, dt);
  }

  /// Returns the highest speed from which steps of constant deceleration end at `distance`: v²/(2a)
  /// + v·dt/2 = distance, the sum of the steps' lengths.
  static double stoppingSpeed(double distance, double deceleration, double dt) {
    const double half = 0.5 * deceleration * dt;
    return -half + std::sqrt(half * half + 2 * deceleration * distance);
  }

 private:
  // Parameters are passed by value, unlike those of std::min, so that a compiler can vectorise it.
  static double smaller(double a, double b) { return a < b ? a : b; }
  static double larger(double a, double b) { return a > b ? a : b; }
};

}  // namespace kiva
