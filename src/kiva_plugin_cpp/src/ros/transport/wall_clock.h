// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>

namespace kiva_ros {

/// Real time that no change of the system's time touches.
using WallClock = std::chrono::steady_clock;

}  // namespace kiva_ros
