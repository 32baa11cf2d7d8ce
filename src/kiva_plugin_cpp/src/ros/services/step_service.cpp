// SPDX-License-Identifier: Apache-2.0
#include "step_service.h"

#include <string>

#include "ros/transport/service_caller.h"

namespace kiva_ros {

StepService::StepService(ros::NodeHandle& node, SimulationThread& simulation)
    : simulation_(simulation), server_(node.advertiseService("step", &StepService::step, this)) {}

bool StepService::step(
    ros::ServiceEvent<warehouse_msgs::Step::Request, warehouse_msgs::Step::Response>& call) {
  const ServiceCaller caller(server_.getService(), call.getConnectionHeader());
  warehouse_msgs::Step::Response& response = call.getResponse();
  try {
    const SimulationThread::Stepped now =
        simulation_.step(call.getRequest().steps, [&caller] { return caller.isGone(); });
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
