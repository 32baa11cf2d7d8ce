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
  Impact impact;                  ///< So far, its normal from b to a.
  std::uint64_t tell_at = 0;      ///< The step at which it is told, if it is over; 0 = it has been.
  std::uint64_t tell_latest = 0;  ///< The step at which it is told, over or not.
};

/// A collision that was seen, and stops that robot.
struct Crash {
  int kiva_id = 0;
  std::string with;  ///< A model's name.
};

/// A sudden change of a storage unit's velocity.
struct Jolt {
  int unit = -1;   ///< A model's slot.
  Vector3 change;  ///< In world [m/s].
};

/// Which models touch, and what that did to them.
struct ContactLog {
  std::vector<TouchingPair> touching;
  std::vector<Contact> contacts;  ///< Scratch.
  std::vector<Crash> crashes;     ///< Seen in the last step.
  std::vector<Jolt> jolts;        ///< Seen in this step; scratch.
};

}  // namespace kiva
