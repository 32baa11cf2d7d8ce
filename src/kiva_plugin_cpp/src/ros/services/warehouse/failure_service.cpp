// SPDX-License-Identifier: Apache-2.0
#include "ros/services/warehouse/failure_service.h"

#include <stdexcept>
#include <string>

#include "ros/services/base/service_answer.h"

namespace kiva_ros {
namespace {

using warehouse_msgs::FailRequest;

void act(kiva::World& world, const FailRequest& request) {
  if (request.kind > FailRequest::WHEEL_SLIPS) {
    throw std::invalid_argument("kind is " + std::to_string(request.kind) +
                                "; 0 to 5 was expected");
  }
  if (request.kind == FailRequest::REPAIRED) return world.repair(request.kiva_id);
  world.fail(request.kiva_id, static_cast<kiva::Failure>(request.kind), request.repair_time);
}

}  // namespace

FailureService::FailureService(ros::NodeHandle& root, SimulationThread& simulation)
    : simulation_(simulation),
      server_(serveCommand(root, "warehouse/fail", &FailureService::fail, this)) {}

bool FailureService::fail(const warehouse_msgs::Fail::Request& request,
                          warehouse_msgs::Fail::Response& response) {
  return reply(response, [&] {
    simulation_.change([&](kiva::World& world) { act(world, request); });
    return std::string();
  });
}

}  // namespace kiva_ros
