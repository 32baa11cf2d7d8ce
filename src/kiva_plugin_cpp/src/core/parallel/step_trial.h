// SPDX-License-Identifier: Apache-2.0
//
// Periodic trials of whether threads speed up the steps of a world. That depends on the share of
// loops in a step, on the cores and on their other load.
#pragma once

#include <array>
#include <chrono>
#include <vector>

namespace kiva {

/// Times some steps with other threads and some without, and lets loops be shared until the next
/// trial if that is faster by enough. Only the duration of steps depends on it.
class StepTrial {
 public:
  static constexpr int kFirst = 500;      // steps until the first trial, when caches are warm
  static constexpr int kSteps = 128;      // steps of a trial
  static constexpr int kBetween = 20000;  // steps from trial to trial

  bool shares() const { return shares_; }

  void beginStep() {
    if (tries_) begin_ = Clock::now();
  }
  /// Ends a step that had loops to share.
  void endStep();

 private:
  using Clock = std::chrono::steady_clock;
  void decide();

  static constexpr int kTurn =
      8;  // consecutive steps of a trial with other threads, then as many without

  bool shares_ = true;
  bool tries_ = false;
  int left_ = kFirst;  // steps until the trial begins, or ends
  Clock::time_point begin_;
  std::array<std::vector<double>, 2>
      times_;  // durations of steps without and with other threads [s]
};

}  // namespace kiva
