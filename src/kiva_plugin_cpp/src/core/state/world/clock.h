// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cmath>
#include <cstdint>

namespace kiva {

/// The time of a world, counted in steps.
struct Clock {
  double dt = 0.001;              ///< Step size [s].
  double dt_since_time = 0;       ///< When the present step size began [s],
  std::uint64_t dt_since = 0;     ///< and after how many steps.
  std::uint64_t steps = 0;        ///< Since the last reset of time.
  std::uint64_t total_steps = 0;  ///< Ever; schedules count by these.

  /// Returns the simulated time since the last reset [s].
  double time() const { return dt_since_time + static_cast<double>(steps - dt_since) * dt; }
  /// Returns the number of steps that last at least that long [s].
  std::uint64_t stepsIn(double seconds) const {
    return static_cast<std::uint64_t>(std::ceil(seconds / dt));
  }
  void advance() {
    ++steps;
    ++total_steps;
  }
  /// Changes the step size from now on [s].
  void setStepSize(double seconds) {
    dt_since_time = time();
    dt_since = steps;
    dt = seconds;
  }
  void resetTime() {
    steps = dt_since = 0;
    dt_since_time = 0;
  }
};

}  // namespace kiva
