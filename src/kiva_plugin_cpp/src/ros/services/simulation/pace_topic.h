// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>
#include <warehouse_msgs/Pace.h>

#include "ros/simulation/simulation_thread.h"

namespace kiva_ros {

/// Subscribes to `/warehouse/pace`, by which nodes tell how far simulated time may pass before they
/// have spoken again.
class PaceTopic {
 public:
  PaceTopic(ros::NodeHandle& root, SimulationThread& simulation);

 private:
  void limit(const ros::MessageEvent<const warehouse_msgs::Pace>& event);

  SimulationThread& simulation_;
  ros::Subscriber subscriber_;
};

}  // namespace kiva_ros
