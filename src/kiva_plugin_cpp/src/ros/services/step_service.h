// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>
#include <warehouse_msgs/Step.h>

#include "ros/simulation/simulation_thread.h"

namespace kiva_ros {

/// ~step: time by the step, for those who want to see what each does. A call may take as long as
/// its steps do, so `node` is best that of a thread of its own.
class StepService {
 public:
  StepService(ros::NodeHandle& node, SimulationThread& simulation);

 private:
  bool step(ros::ServiceEvent<warehouse_msgs::Step::Request, warehouse_msgs::Step::Response>& call);

  SimulationThread& simulation_;
  ros::ServiceServer server_;
};

}  // namespace kiva_ros
