// SPDX-License-Identifier: Apache-2.0
#include "ros/services/warehouse/mode_service.h"

#include <warehouse_msgs/SetRobotMode.h>

#include <string>

#include "ros/services/base/service_answer.h"

namespace kiva_ros {

static_assert(int(kiva::kMostMode) == int(warehouse_msgs::SetRobotModeRequest::OUT_OF_SERVICE));

ModeService::ModeService(ros::NodeHandle& node, SimulationThread& simulation)
    : simulation_(simulation),
      server_(serveCommand(node, "keep_robot_mode", &ModeService::keep, this)) {}

bool ModeService::keep(const Request& request, Response& response) {
  return reply(response, [&] {
    simulation_.run([&](kiva::World& world) {
      if (request.timeline != simulation_.timeline()) {
        throw ServiceRefusal("the world was reset or restored meanwhile");
      }
      world.keepMode(request.kiva_id, request.mode);
    });
    return std::string();
  });
}

}  // namespace kiva_ros
