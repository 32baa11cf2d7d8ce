// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>
#include <warehouse_msgs/FleetState.h>

#include "ros/simulation/simulation_thread.h"

namespace kiva_ros {

/// Takes in `/warehouse/shadows`: where robots are that are elsewhere, and what they do. Each of
/// them is the shadow of one in the world from then on.
class ShadowTopic {
 public:
  ShadowTopic(ros::NodeHandle& root, SimulationThread& simulation);

 private:
  using Message = boost::shared_ptr<const warehouse_msgs::FleetState>;
  void take(const Message& message);

  SimulationThread& simulation_;
  ros::Subscriber subscriber_;
};

}  // namespace kiva_ros
