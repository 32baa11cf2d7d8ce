// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace kiva {

/// Wraps to (-pi, pi].
inline double wrapAngle(double angle) { return std::remainder(angle, 2 * M_PI); }

/// The heading nearest to `near` that points along `angle`; of two opposite ones the left turn.
inline double headingNear(double near, double angle) {
  const double turn = wrapAngle(angle - near);
  return near + (turn < -M_PI + 1e-6 ? turn + 2 * M_PI : turn);
}

}  // namespace kiva
