// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>

namespace kiva {

/// Wraps to (-pi, pi].
inline double wrapAngle(double angle) { return std::remainder(angle, 2 * M_PI); }

}  // namespace kiva
