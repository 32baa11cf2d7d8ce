// SPDX-License-Identifier: Apache-2.0
#include "performance.h"

#include <gazebo_msgs/PerformanceMetrics.h>

#include "convert.h"

namespace kiva_ros {
namespace {

constexpr double kRate = 5;  // [Hz], Gazebo's
constexpr int kQueue = 10;

}  // namespace

Performance::Performance(ros::NodeHandle& node, Engine& engine)
    : engine_(engine),
      publisher_(node.advertise<gazebo_msgs::PerformanceMetrics>("performance_metrics", kQueue)),
      timer_(node.createWallTimer(ros::WallDuration(1 / kRate),
                                  [this](const ros::WallTimerEvent&) { publish(); })) {}

void Performance::publish() {
  if (publisher_.getNumSubscribers() == 0) return;
  try {
    gazebo_msgs::PerformanceMetrics out;
    out.header = header(engine_.run([](kiva::World& world) { return world.time(); }), "");
    out.real_time_factor = engine_.realTimeFactor();
    publisher_.publish(out);
  } catch (const std::exception&) {  // it is shutting down
  }
}

}  // namespace kiva_ros
