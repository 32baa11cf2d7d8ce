// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>

#include <vector>

#include "ros/simulation/simulation_thread.h"

namespace kiva_ros {

/// Subscribes to the command topics, once each for any number of robots, and publishes who sent
/// what on /warehouse/commands, but for paths: planners send many a second. Journals listen there:
/// with a second subscriber of a command topic, a client could no longer tell by its number of
/// connections that the world hears it.
class CommandTopics {
 public:
  CommandTopics(ros::NodeHandle& root, SimulationThread& simulation);

 private:
  ros::Publisher heard_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace kiva_ros
