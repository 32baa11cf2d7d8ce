// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "core/physics/physics.h"
#include "kiva_plugin_cpp/world.h"

namespace kiva {

/// Two models in contact.
struct TouchingPair {
  int model_a = -1, model_b = -1;
  std::uint64_t last_step = 0;
  Impact impact;                    ///< The impact so far, its normal from b to a.
  std::uint64_t report_at = 0;      ///< Step of the report, if it is over; 0 = reported.
  std::uint64_t report_latest = 0;  ///< Step of the report, over or not.
};

/// A collision that stops a robot.
struct Crash {
  int kiva_id = 0;
  std::string with;  ///< A model's name.
};

/// A sudden change of a storage unit's velocity.
struct Jolt {
  int unit = -1;   ///< A model's slot.
  Vector3 change;  ///< Change of velocity in world [m/s].
};

/// Models that touch, and the effects of their impacts.
struct ContactLog {
  std::vector<TouchingPair> touching;
  std::vector<Contact> contacts;  ///< Scratch.
  std::vector<Crash> crashes;     ///< Crashes of the last step.
  std::vector<Jolt> jolts;        ///< Jolts of this step; scratch.
};

}  // namespace kiva
