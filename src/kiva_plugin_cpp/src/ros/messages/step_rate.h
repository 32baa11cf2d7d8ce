// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace kiva_ros {

/// Returns the number of steps of `step_size` [s] between two messages at `rate` [Hz]; 1 for rate
/// 0.
inline std::uint64_t stepsPer(double rate, double step_size) {
  if (rate <= 0) return 1;
  return static_cast<std::uint64_t>(std::max(1.0, std::round(1 / (rate * step_size))));
}

}  // namespace kiva_ros
