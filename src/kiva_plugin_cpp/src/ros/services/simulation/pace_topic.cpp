// SPDX-License-Identifier: Apache-2.0
#include "ros/services/simulation/pace_topic.h"

#include <string>

namespace kiva_ros {
namespace {

constexpr int kPaceQueue = 100;

}  // namespace

PaceTopic::PaceTopic(ros::NodeHandle& root, SimulationThread& simulation)
    : simulation_(simulation),
      subscriber_(root.subscribe("warehouse/pace", kPaceQueue, &PaceTopic::limit, this,
                                 ros::TransportHints().tcpNoDelay())) {}

void PaceTopic::limit(const ros::MessageEvent<const warehouse_msgs::Pace>& event) {
  const warehouse_msgs::Pace& pace = *event.getConstMessage();
  const double lookahead = pace.lookahead.toSec();
  const std::string& node = event.getPublisherName();
  if (lookahead < 0) {
    ROS_WARN_THROTTLE(10, "/warehouse/pace of %s: lookahead is %g s; 0 or more was expected",
                      node.c_str(), lookahead);
  } else if (lookahead == 0) {
    simulation_.releasePace(node);
  } else {
    simulation_.limitPace(node, pace.stamp.toSec() + lookahead);
  }
}

}  // namespace kiva_ros
