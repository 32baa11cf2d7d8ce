// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <vector>

#include "kiva_plugin_cpp/failures.h"
#include "kiva_plugin_cpp/fleet.h"

namespace kiva {

/// A failure of a robot that is not repaired yet.
struct Defect {
  int kiva_id = 0;
  Failure failure = Failure::kMotor;
  double left = 0;   ///< Time until its repair [s]; +inf = until a client repairs it.
  RobotReport last;  ///< Last report before the failure, of use while the radio is lost.
};

/// The defects of a fleet, and the time of the next one.
struct FailureState {
  std::vector<Defect> defects;  ///< In order of occurrence.
  double exposure = 0;          ///< Time until the next random defect [robot seconds].
  std::uint64_t count = 0;      ///< Number of draws of `exposure` so far.
};

}  // namespace kiva
