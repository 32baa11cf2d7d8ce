// SPDX-License-Identifier: Apache-2.0
//
// The constants of messages as enums; written by scripts/message_enums from warehouse_msgs.
#pragma once

#include <cstdint>

namespace kiva {

/// The status of a robot.
enum class Status : std::uint8_t {
  kIdle = 0,
  kBusy = 1,
  kBlocked = 2,
};

/// The activity of a robot.
enum class State : std::uint8_t {
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

/// The kinds of events.
enum class EventKind : std::uint8_t {
  kAccepted = 0,
  kRefused = 1,
  kDone = 2,
  kBlocked = 3,
  kLifted = 4,
  kDropped = 5,
  kCollision = 6,
  kSpawned = 7,
  kDeleted = 8,
  /// A robot no longer knows where it is, and stops.
  kLost = 9,
  /// Something in a robot is broken.
  kFailed = 10,
  kRepaired = 11,
  /// A storage unit tipped off the robot that carried it.
  kTipped = 12,
  /// An item fell off its storage unit (other).
  kFell = 13,
  /// An item that fell is back on its storage unit (other).
  kPickedUp = 14,
};

/// The failures of a robot.
enum class Failure : std::uint8_t {
  /// The drive has no torque, and its brakes close: it stands where it can.
  kMotor = 1,
  /// The tower stands wherever it is.
  kLift = 2,
  /// No scans, and the robot stands, since it does not see people.
  kLaser = 3,
  /// It hears and reports nothing; it completes the commands that it has.
  kRadio = 4,
  /// Less grip: it turns and brakes as that allows.
  kWheelSlip = 5,
};

}  // namespace kiva
