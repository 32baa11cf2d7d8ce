// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

#include "ros/transport/wall_clock.h"

namespace kiva_ros {

/// Decides when steps are due so that simulated time follows the wall clock.
/// Steps come in batches, since waking up for each costs more than a small world's step; a batch is
/// short against the reaction time of clients. Lost time is not caught up: a world that was too
/// slow continues without a burst.
class Pacer {
 public:
  /// `rtf`: simulated seconds a wall second; 0 = as fast as possible.
  Pacer(double step_size, double rtf);

  bool paced() const { return rtf_ > 0; }
  /// Returns whether simulated time may pass faster than the wall clock.
  bool isFast() const { return !paced() || rtf_ > 1; }
  /// Restarts the pace at `now`.
  void restart(WallClock::time_point now);
  /// Returns the number of steps that are due; without pacing, the number to make before the clock
  /// is read again.
  int due(WallClock::time_point now);
  void stepped() { ++done_; }
  /// Returns when the next batch is due.
  WallClock::time_point next() const;

 private:
  double wallOwed(WallClock::time_point now) const;

  double rtf_;
  double wall_per_step_ = 0;  ///< [s]
  int batch_ = 1;
  WallClock::time_point origin_;
  std::int64_t done_ = 0;  ///< Steps since origin_.
};

}  // namespace kiva_ros
