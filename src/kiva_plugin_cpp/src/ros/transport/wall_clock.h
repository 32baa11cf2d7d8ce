// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace kiva_ros {

/// The monotonic clock, which no change of the system's time affects.
using WallClock = std::chrono::steady_clock;

}  // namespace kiva_ros
