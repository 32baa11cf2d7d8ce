// SPDX-License-Identifier: Apache-2.0
#include "ros/services/base/progress.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace {

TEST(Progress, LongWorkSaysHowFarItIsNowAndThen) {
  std::vector<std::string> said;
  kiva_ros::WallClock::time_point now;
  kiva_ros::Progress progress([&](const std::string& text) { said.push_back(text); },
                              [&] { return now; });
  for (int second = 0; second < 8; ++second) {
    progress.at("built", second * 10, 100);
    now += std::chrono::seconds(1);
  }
  EXPECT_EQ(said, (std::vector<std::string>{"built 30 of 100 models", "built 60 of 100 models"}));
}

TEST(Progress, ShortWorkIsNotMentioned) {
  int said = 0;
  kiva_ros::Progress progress([&](const std::string&) { ++said; });
  progress.at("built", 1, 2);
  EXPECT_EQ(said, 0);
}

}  // namespace
