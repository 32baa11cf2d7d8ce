// SPDX-License-Identifier: Apache-2.0
#include "ros/transport/steady_use.h"

#include <gtest/gtest.h>

namespace {

constexpr std::size_t kUsed = 100'000'000;  // [bytes]

TEST(SteadyUse, OneLookAloneTellsNothing) {
  kiva_ros::SteadyUse use;
  EXPECT_FALSE(use.isSteadyAt(kUsed));
  EXPECT_TRUE(use.isSteadyAt(kUsed));
}

TEST(SteadyUse, QueuesThatAreReadAreWaitedFor) {
  kiva_ros::SteadyUse use;
  for (const std::size_t waiting : {40, 25, 10, 2}) {
    EXPECT_FALSE(use.isSteadyAt(kUsed + waiting * kUsed / 100)) << waiting;
  }
  EXPECT_FALSE(use.isSteadyAt(kUsed));
  EXPECT_TRUE(use.isSteadyAt(kUsed));
}

TEST(SteadyUse, ItIsSteadyToOnePartInAHundredUpAndDown) {
  for (const std::size_t before : {kUsed - kUsed / 100, kUsed + kUsed / 100}) {
    kiva_ros::SteadyUse use;
    use.isSteadyAt(before);
    EXPECT_TRUE(use.isSteadyAt(kUsed)) << before;
  }
  for (const std::size_t before : {kUsed - kUsed / 100 - 1, kUsed + kUsed / 100 + 1}) {
    kiva_ros::SteadyUse use;
    use.isSteadyAt(before);
    EXPECT_FALSE(use.isSteadyAt(kUsed)) << before;
  }
}

TEST(SteadyUse, WhatWasSteadyBeforeARestartDoesNotCount) {
  kiva_ros::SteadyUse use;
  use.isSteadyAt(kUsed);
  use.restart();
  EXPECT_FALSE(use.isSteadyAt(kUsed));
}

}  // namespace
