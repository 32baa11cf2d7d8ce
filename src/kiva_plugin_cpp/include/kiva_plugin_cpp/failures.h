// SPDX-License-Identifier: Apache-2.0
//
// What breaks in a robot, by order or by chance, and how long until it is repaired.
#pragma once

#include <cstdint>

namespace kiva {

/// What is broken. Values as in warehouse_msgs/Fail.
enum class Failure : std::uint8_t {
  kMotor = 1,      ///< The drive has no torque, and its brakes close: it stands where it can.
  kLift = 2,       ///< The tower stands wherever it is.
  kLaser = 3,      ///< Blind: no scans, and the robot stands, since it does not see what comes.
  kRadio = 4,      ///< It hears no command and reports nothing; what it has been told it does.
  kWheelSlip = 5,  ///< Its wheels have less grip: it turns and brakes as that allows.
};
constexpr int kFailureKinds = 5;

/// In Fleet::failures.
constexpr std::uint8_t bitOf(Failure failure) {
  return static_cast<std::uint8_t>(1u << static_cast<unsigned>(failure));
}

/// In Fleet::failures, beside those: its battery is empty, and it stands.
constexpr std::uint8_t kEmptyBattery = 1;

}  // namespace kiva
