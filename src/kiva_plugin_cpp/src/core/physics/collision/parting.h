// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace kiva {

/// Largest speed with which bodies that overlap are moved apart [m/s]. They are shifted for a step
/// and keep their velocities, so that an overlap gives them no energy, however deep it is.
constexpr double kMaxPartingSpeed = 0.2;

/// Returns the speed with which two bodies are to be moved apart [m/s] that are that far from each
/// other [m], negative where they overlap: a share of the overlap in a step of `dt` [s].
inline double partingSpeed(double distance, double share, double dt) {
  return std::clamp(-distance * share / dt, 0.0, kMaxPartingSpeed);
}

}  // namespace kiva
