// SPDX-License-Identifier: Apache-2.0
//
// Topics that come and go with their robots leave nothing in the handle that advertises them.
#include <gtest/gtest.h>
#include <malloc.h>
#include <std_msgs/String.h>

#include <memory>
#include <string>
#include <vector>

#include "ros/gazebo_plugins/base/plugin_inputs.h"
#include "ros/transport/latched_publisher.h"
#include "ros/transport/subscriber_counts.h"

namespace kiva_ros {
namespace {

constexpr int kTopics = 200;
constexpr int kTimes = 5;
constexpr double kRest = 40;  // [bytes] of a topic: below the smallest thing that could be kept

double inUse() { return static_cast<double>(mallinfo2().uordblks); }

void uncounted(int) {}

/// Returns what each topic leaves behind that `make` makes and its return value keeps [bytes].
template <typename Make>
double keptOf(Make make) {
  const auto comeAndGo = [&] {
    std::vector<decltype(make(std::string()))> topics;
    for (int i = 0; i < kTopics; ++i) topics.push_back(make("topic" + std::to_string(i)));
  };
  comeAndGo();  // what roscpp makes once
  const double before = inUse();
  for (int i = 0; i < kTimes; ++i) comeAndGo();
  return (inUse() - before) / (kTimes * kTopics);
}

TEST(TopicMemory, countedTopics) {
  ros::NodeHandle node;
  EXPECT_LT(keptOf([&](const std::string& topic) {
              return advertiseCounted<std_msgs::String>(node, topic, 1, uncounted);
            }),
            kRest);
}

TEST(TopicMemory, latchedTopics) {
  ros::NodeHandle node;
  EXPECT_LT(keptOf([&](const std::string& topic) {
              LatchedPublisher<std_msgs::String> out(node, topic, 1, uncounted);
              out.publish({});
              return out;
            }),
            kRest);
}

TEST(TopicMemory, inputsOfPlugins) {
  ros::NodeHandle node;
  EXPECT_LT(keptOf([&](const std::string& topic) {
              return std::make_shared<TypedInputTopic<std_msgs::String>>(node, topic, topic, true);
            }),
            kRest);
}

}  // namespace
}  // namespace kiva_ros

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "topic_memory");
  const ros::NodeHandle until_the_end;
  return RUN_ALL_TESTS();
}
