// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/ray_fan.h"

namespace kiva {

/// Robots whose scans have the same period, by the step within it.
struct ScanRound {
  std::uint64_t period = 0;  ///< [steps]
  std::vector<std::vector<int>> robots_at;
};

/// The lasers of a fleet: their rays, when they scan, and which robots looked ahead.
struct Scans {
  std::vector<RayFan> fans;
  std::vector<ScanRound> rounds;
  std::uint64_t rounds_revision = ~0ull;  ///< The models' revision when the rounds were made.
  std::vector<int> due;                   ///< Robots whose scan is due at this step.
  std::vector<int> sighted;               ///< Robots whose lasers looked ahead in the last step.
};

}  // namespace kiva
