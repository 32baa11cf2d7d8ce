// SPDX-License-Identifier: Apache-2.0
//
// What breaks in a robot, by order or by chance, and how long until it is repaired.
#pragma once

#include <cstdint>

#include "kiva_plugin_cpp/message_enums.h"

namespace kiva {

constexpr int kFailureKinds = static_cast<int>(Failure::kWheelSlip);

/// Returns the bit of a failure in Fleet::failures.
constexpr std::uint8_t bitOf(Failure failure) {
  return static_cast<std::uint8_t>(1u << static_cast<unsigned>(failure));
}

/// In Fleet::failures, beside those bits: the battery is empty, and the robot stands.
constexpr std::uint8_t kEmptyBattery = 1;

}  // namespace kiva
