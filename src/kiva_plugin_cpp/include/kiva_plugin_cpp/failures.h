// SPDX-License-Identifier: Apache-2.0
//
// Failures of robots, ordered or random, and their repair times.
#pragma once

#include <cstdint>

#include "kiva_plugin_cpp/message_enums.h"

namespace kiva {

constexpr int kFailureKinds = static_cast<int>(Failure::kWheelSlip);

/// Returns the bit of a failure in Fleet::failures.
constexpr std::uint8_t bitOf(Failure failure) {
  return static_cast<std::uint8_t>(1u << static_cast<unsigned>(failure));
}

/// The bit of Fleet::failures for an empty battery, with which the robot stands.
constexpr std::uint8_t kEmptyBattery = 1;

}  // namespace kiva
