// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>

namespace kiva {

/// Largest speed at which overlapping bodies are moved apart [m/s]. They are shifted for a step and
/// keep their velocities, so that an overlap of any depth gives them no energy.
constexpr double kMaxPartingSpeed = 0.2;

/// Returns the speed at which two bodies at `distance` [m], negative where they overlap, are moved
/// apart [m/s]: a share of the overlap in a step of `dt` [s].
inline double partingSpeed(double distance, double share, double dt) {
  return std::clamp(-distance * share / dt, 0.0, kMaxPartingSpeed);
}

}  // namespace kiva
