// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>

#include <vector>

#include "ros/simulation/simulation_thread.h"

namespace kiva_ros {

/// Subscribes to the command topics, once each for any number of robots.
class CommandTopics {
 public:
  CommandTopics(ros::NodeHandle& root, SimulationThread& simulation);

 private:
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace kiva_ros
