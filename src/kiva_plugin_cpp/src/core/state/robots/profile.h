// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace kiva {

/// A reference that goes to a target with limited speed and acceleration and stands there.
///
/// The target and the deceleration may change at any step, so that a robot can be told to stop
/// earlier than planned. Positions and speeds are of one axis, in [m, m/s] or [rad, rad/s].
struct Profile {
  double position = 0;
  double speed = 0;

  /// What is left of a way when rounding errors are all that is left of it.
  static constexpr double kThere = 1e-12;

  /// One step of `dt` towards `target`. `acceleration` 0: at full speed at once, and at rest at
  /// once. `deceleration` is what the end of the run is planned with.
  void advance(double target, double top_speed, double acceleration, double deceleration,
               double dt) {
    const double distance = std::abs(target - position);
    const double sign = target < position ? -1.0 : 1.0;
    const double forward = sign * speed;
    const double braked =
        larger(stoppingSpeed(distance, deceleration, dt), forward - deceleration * dt);
    const double ramped = smaller(smaller(top_speed, forward + acceleration * dt), braked);
    const double wanted = larger(acceleration > 0.0 ? ramped : top_speed, 0.0);
    const double next = smaller(wanted, distance * (1 / dt));
    const double moved = position + sign * next * dt;
    speed = sign * next;
    position = distance - next * dt <= kThere ? target : moved;
  }

  /// One step of `dt` towards a stop after v²/(2 deceleration), however long steps are;
  /// deceleration 0: at rest at once. `stop_at` is where that is: the first step sets it, where it
  /// is kNowhere.
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

  /// Returns the highest speed now from which steps of constant deceleration end on `distance`:
  /// v²/(2a) + v·dt/2 = distance, the sum of the steps' lengths.
  static double stoppingSpeed(double distance, double deceleration, double dt) {
    const double half = 0.5 * deceleration * dt;
    return -half + std::sqrt(half * half + 2 * deceleration * distance);
  }

 private:
  // By value, unlike std::min: a compiler can do several at a time.
  static double smaller(double a, double b) { return a < b ? a : b; }
  static double larger(double a, double b) { return a > b ? a : b; }
};

}  // namespace kiva
