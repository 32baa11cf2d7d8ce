// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace kiva {

constexpr double kHalfPi = M_PI / 2;  ///< Between two headings along the grid [rad].

/// Returns the heading along the grid that is nearest.
inline double squareTo(double yaw) { return std::round(yaw / kHalfPi) * kHalfPi; }

/// Wraps to (-pi, pi].
inline double wrapAngle(double angle) { return std::remainder(angle, 2 * M_PI); }

/// Returns the heading nearest to `near` that points along `angle`; of two opposite ones the left
/// turn.
inline double headingNear(double near, double angle) {
  const double turn = wrapAngle(angle - near);
  return near + (turn < -M_PI + 1e-6 ? turn + 2 * M_PI : turn);
}

}  // namespace kiva
