// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kiva_plugin_cpp/failures.h"
#include "kiva_plugin_cpp/fleet.h"

namespace kiva {

/// What is broken in a robot now.
struct Defect {
  int kiva_id = 0;
  Failure failure = Failure::kMotor;
  double left = 0;   ///< Until it is repaired [s]; +inf = until a client repairs it.
  RobotReport last;  ///< Heard before the failure; of use while the radio is lost.
};

/// The defects of a fleet, and when the next one is due.
struct FailureState {
  std::vector<Defect> defects;  ///< In the order in which they came.
  double exposure = 0;          ///< Until the next one by chance [robot seconds],
  std::uint64_t count = 0;      ///< which has been drawn so often.
};

}  // namespace kiva
