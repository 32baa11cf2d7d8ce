// SPDX-License-Identifier: Apache-2.0
//
// How far time may pass before nodes have spoken again, by a wall clock that the test sets.
#include "ros/simulation/pace_limit.h"

#include <gtest/gtest.h>

#include <chrono>

namespace kiva_ros {
namespace {

using std::chrono::seconds;
using Names = std::vector<std::string>;

class Limit : public ::testing::Test {
 protected:
  /// Names of the nodes that are left behind at `time` [s], which stands since `since`.
  Names silent(double time, WallClock::time_point since, WallClock::time_point now) {
    Names out;
    for (const auto& silent : limit_.releaseSilent(time, since, now)) out.push_back(silent.node);
    return out;
  }

  PaceLimit limit_;
  WallClock::time_point now_{std::chrono::hours(1)};
};

TEST_F(Limit, TimeWaitsForTheNodeThatIsFarthestBehind) {
  EXPECT_FALSE(limit_.holds(1e9));
  limit_.allow("/fleet", 2.3, now_);
  limit_.allow("/shift", 2.1, now_);
  EXPECT_FALSE(limit_.holds(2.099));
  EXPECT_TRUE(limit_.holds(2.1));
  limit_.allow("/shift", 2.9, now_);
  EXPECT_FALSE(limit_.holds(2.299));
  EXPECT_TRUE(limit_.holds(2.3));
  limit_.release("/fleet");
  EXPECT_FALSE(limit_.holds(2.899));
}

TEST_F(Limit, ANodeThatSaysNothingForTenSecondsIsWaitedForNoLonger) {
  limit_.allow("/fleet", 1.0, now_);
  limit_.allow("/shift", 5.0, now_);
  EXPECT_EQ(silent(1.0, now_, now_ + seconds(9)), Names());
  EXPECT_EQ(silent(0.5, now_, now_ + seconds(60)), Names()) << "it holds nothing up";
  EXPECT_EQ(silent(1.0, now_ + seconds(50), now_ + seconds(59)), Names())
      << "it may have had nothing to say before time stood still";
  EXPECT_EQ(silent(1.0, now_, now_ + seconds(10)), Names({"/fleet"}));
  EXPECT_FALSE(limit_.holds(4.0));
  EXPECT_TRUE(limit_.holds(5.0));
}

TEST_F(Limit, ANodeThatIsStillToStartIsWaitedForAMinute) {
  limit_.await("/fleet", 0.1, now_);
  EXPECT_EQ(silent(0.1, now_, now_ + seconds(59)), Names());
  limit_.allow("/fleet", 0.4, now_ + seconds(59));
  EXPECT_EQ(silent(0.4, now_ + seconds(59), now_ + seconds(69)), Names({"/fleet"}))
      << "it has started";
  limit_.await("/shift", 0.1, now_);
  EXPECT_EQ(silent(0.1, now_, now_ + seconds(60)), Names({"/shift"}));
}

TEST_F(Limit, WhoHasStartedIsNotSilentAsLongAsTimeWaitsForAnotherToStart) {
  limit_.await("/fleet", 0.1, now_);
  limit_.allow("/shift", 0.1, now_);
  EXPECT_EQ(silent(0.1, now_, now_ + seconds(40)), Names()) << "it is /fleet that keeps time";
  limit_.allow("/fleet", 0.4, now_ + seconds(40));
  EXPECT_EQ(silent(0.1, now_, now_ + seconds(49)), Names());
  EXPECT_EQ(silent(0.1, now_, now_ + seconds(50)), Names({"/shift"}));
}

TEST_F(Limit, WhoHasStartedIsGivenTenSecondsMoreOnceTheOtherIsWaitedForNoLonger) {
  limit_.await("/fleet", 0.1, now_);
  limit_.allow("/shift", 0.1, now_);
  EXPECT_EQ(silent(0.1, now_, now_ + seconds(60)), Names({"/fleet"}));
  EXPECT_EQ(silent(0.1, now_, now_ + seconds(69)), Names());
  EXPECT_EQ(silent(0.1, now_, now_ + seconds(70)), Names({"/shift"}));
}

TEST_F(Limit, StepsThatRoundADecimalTimeStopAtIt) {
  limit_.allow("/fleet", 0.1 + 0.2, now_);
  double time = 0;
  int steps = 0;
  for (; !limit_.holds(time); ++steps) time = (steps + 1) * 0.001;
  EXPECT_EQ(steps, 300);
}

TEST_F(Limit, WhatWasSaidOfAnotherTimelineIsForgotten) {
  limit_.allow("/fleet", 3.0, now_);
  limit_.releaseAll();
  EXPECT_FALSE(limit_.holds(7.0));
}

}  // namespace
}  // namespace kiva_ros
