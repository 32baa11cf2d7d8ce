// SPDX-License-Identifier: Apache-2.0
#include "ros/services/simulation/step_service.h"

#include <string>

#include "ros/services/base/service_answer.h"
#include "ros/transport/service_caller.h"

namespace kiva_ros {

StepService::StepService(ros::NodeHandle& node, SimulationThread& simulation)
    : simulation_(simulation),
      calls_(node.resolveName("step")),
      server_(node.advertiseService("step", &StepService::step, this)) {}

bool StepService::step(
    ros::ServiceEvent<warehouse_msgs::Step::Request, warehouse_msgs::Step::Response>& call) {
  calls_.tell(call.getCallerName(), call.getRequest());
  const ServiceCaller caller(server_.getService(), call.getConnectionHeader());
  return reply(call.getResponse(), [&] {
    const SimulationThread::Stepped now =
        simulation_.step(call.getRequest().steps, [&caller] { return caller.isGone(); });
    call.getResponse().stamp = ros::Time(now.time);
    return "step " + std::to_string(now.steps) + ", " + std::to_string(now.waiting) +
           " commands wait";
  });
}

}  // namespace kiva_ros
