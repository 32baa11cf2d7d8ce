// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gazebo_msgs/LinkState.h>
#include <ros/ros.h>

#include <vector>

#include "ros/simulation/simulation_thread.h"

namespace kiva_ros {

/// Serves links as Gazebo's node does: get_link_state, set_link_state and its topic,
/// get_link_properties, set_link_properties, apply_body_wrench, clear_body_wrenches.
class LinkServices {
 public:
  LinkServices(ros::NodeHandle& node, SimulationThread& simulation);

 private:
  void setByTopic(const gazebo_msgs::LinkState& state);

  SimulationThread& simulation_;
  std::vector<ros::ServiceServer> servers_;
  ros::Subscriber set_link_;
};

}  // namespace kiva_ros
