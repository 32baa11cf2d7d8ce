// SPDX-License-Identifier: Apache-2.0
#include "ros/services/simulation/performance_topic.h"

#include <gazebo_msgs/PerformanceMetrics.h>

#include "ros/messages/convert.h"

namespace kiva_ros {
namespace {

constexpr double kRate = 5;  // [Hz], Gazebo's
constexpr int kQueue = 10;

}  // namespace

PerformanceTopic::PerformanceTopic(ros::NodeHandle& node, SimulationThread& simulation)
    : simulation_(simulation),
      publisher_(node.advertise<gazebo_msgs::PerformanceMetrics>("performance_metrics", kQueue)),
      timer_(node.createWallTimer(ros::WallDuration(1 / kRate),
                                  [this](const ros::WallTimerEvent&) { publish(); })) {}

void PerformanceTopic::publish() {
  if (publisher_.getNumSubscribers() == 0) return;
  try {
    gazebo_msgs::PerformanceMetrics out;
    out.header = header(simulation_.run([](kiva::World& world) { return world.time(); }), "");
    out.real_time_factor = simulation_.realTimeFactor();
    publisher_.publish(out);
  } catch (const std::exception&) {  // the node is shutting down
  }
}

}  // namespace kiva_ros
