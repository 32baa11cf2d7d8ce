// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>
#include <warehouse_msgs/Step.h>

#include "ros/services/base/command_service.h"
#include "ros/simulation/simulation_thread.h"

namespace kiva_ros {

/// Serves ~step: advances time step by step, for clients that need the result of each step. A call
/// takes as long as its steps, so `node` is preferably that of a thread of its own.
class StepService {
 public:
  StepService(ros::NodeHandle& node, SimulationThread& simulation);

 private:
  bool step(ros::ServiceEvent<warehouse_msgs::Step::Request, warehouse_msgs::Step::Response>& call);

  SimulationThread& simulation_;
  CallTopic calls_;
  ros::ServiceServer server_;
};

}  // namespace kiva_ros
