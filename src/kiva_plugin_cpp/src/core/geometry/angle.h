// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace kiva {

constexpr double kHalfPi = M_PI / 2;  ///< Angle between two headings along the grid [rad].

/// Returns the nearest heading along the grid.
inline double squareTo(double yaw) { return std::round(yaw / kHalfPi) * kHalfPi; }

/// Returns the angle wrapped to (-pi, pi].
inline double wrapAngle(double angle) { return std::remainder(angle, 2 * M_PI); }

/// Returns the heading nearest to `near` that points along `angle`; the left turn if two are
/// opposite.
inline double headingNear(double near, double angle) {
  const double turn = wrapAngle(angle - near);
  return near + (turn < -M_PI + 1e-6 ? turn + 2 * M_PI : turn);
}

}  // namespace kiva
