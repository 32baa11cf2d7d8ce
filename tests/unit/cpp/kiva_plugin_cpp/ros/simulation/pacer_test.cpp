// SPDX-License-Identifier: Apache-2.0
//
// The node's pacer: simulated time follows a wall clock, which the test sets instead of waiting.
#include "ros/simulation/pacer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>

namespace kiva_ros {
namespace {

constexpr double kStep = 0.001;  // [s]

/// A loop that steps as the node's does, without anything that takes time.
class Pace : public ::testing::Test {
 protected:
  void start(double rtf) {
    pacer_ = Pacer(kStep, rtf);
    pacer_.restart(now_);
  }
  /// Returns the simulated time that passes in `wall` seconds of wall time [s].
  double simulatedIn(double wall) {
    int steps = 0;
    const auto end = now_ + seconds(wall);
    while (pacer_.next() <= end) {
      now_ = std::max(now_, pacer_.next());
      steps += stepAllDue();
    }
    now_ = end;
    return steps * kStep;
  }
  int stepAllDue() {
    const int due = pacer_.due(now_);
    for (int i = 0; i < due; ++i) pacer_.stepped();
    return due;
  }
  static WallClock::duration seconds(double s) {
    return std::chrono::duration_cast<WallClock::duration>(std::chrono::duration<double>(s));
  }

  Pacer pacer_{kStep, 1};
  WallClock::time_point now_{std::chrono::hours(1)};
};

TEST_F(Pace, SimulatedTimePassesAsFastAsWasAskedFor) {
  for (double rtf : {0.01, 0.5, 1.0, 5.0, 100.0}) {
    start(rtf);
    EXPECT_NEAR(simulatedIn(20), 20 * rtf, 0.005 * rtf + kStep) << rtf;
  }
}

TEST_F(Pace, WhatWasLostIsForgivenWithoutABurst) {
  start(1);
  simulatedIn(1);
  now_ += seconds(10);  // the process was stopped
  EXPECT_LE(stepAllDue(), 101);
  EXPECT_NEAR(simulatedIn(5), 5, 0.006);
}

TEST_F(Pace, UnpacedTimeWaitsForNothing) {
  start(0);
  EXPECT_EQ(pacer_.next(), WallClock::time_point::min());
  EXPECT_GT(pacer_.due(now_), 1);
}

}  // namespace
}  // namespace kiva_ros
