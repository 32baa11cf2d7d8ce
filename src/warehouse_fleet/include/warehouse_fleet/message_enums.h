// SPDX-License-Identifier: Apache-2.0
//
// The constants of messages as enums; written by scripts/message_enums from warehouse_msgs.
#pragma once

#include <cstdint>

namespace fleet {

/// The status of a robot.
enum class RobotStatus : std::uint8_t {
  kIdle = 0,
  kBusy = 1,
  kBlocked = 2,
};

/// The activity of a robot.
enum class RobotState : std::uint8_t {
  kIdle = 0,
  kMovingX = 1,
  kMovingY = 2,
  kRotating = 3,
  kLifting = 4,
  kBlocked = 5,
  /// Stands at the last released point of its path.
  kWaiting = 6,
  /// Is driven by /kiva<id>/cmd_vel.
  kSteered = 7,
};

}  // namespace fleet
