// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>

#include <string>
#include <vector>

#include "engine.h"

namespace kiva_ros {

/// The five command topics, one subscriber each whatever the number of robots.
class Commands {
 public:
  Commands(ros::NodeHandle& root, Engine& engine);

 private:
  template <typename Message, typename Convert>
  void subscribe(ros::NodeHandle& root, const std::string& topic, Convert convert);

  Engine& engine_;
  std::vector<ros::Subscriber> subscribers_;
};

}  // namespace kiva_ros
