// SPDX-License-Identifier: Apache-2.0
#include "step_service.h"

#include <string>

namespace kiva_ros {

StepService::StepService(ros::NodeHandle& node, SimulationThread& simulation)
    : simulation_(simulation), server_(node.advertiseService("step", &StepService::step, this)) {}

bool StepService::step(warehouse_msgs::Step::Request& request,
                       warehouse_msgs::Step::Response& response) {
  try {
    const SimulationThread::Stepped now = simulation_.step(request.steps);
    response.success = true;
    response.stamp = ros::Time(now.time);
    response.message =
        "step " + std::to_string(now.steps) + ", " + std::to_string(now.waiting) + " commands wait";
  } catch (const std::exception& error) {
    response.success = false;
    response.message = error.what();
  }
  return true;
}

}  // namespace kiva_ros
