// SPDX-License-Identifier: Apache-2.0
#include "ros/services/warehouse/pick_up_service.h"

#include <stdexcept>
#include <string>

#include "ros/services/base/service_answer.h"

namespace kiva_ros {
namespace {

/// Picks up every item whose unit stands upright, and returns why the others were refused.
std::string pickUpAll(kiva::World& world) {
  std::string refusals;
  for (const kiva::FallenItem& item : world.fallenItems()) {
    try {
      world.pickUp(item.name);
    } catch (const std::invalid_argument& error) {
      refusals += (refusals.empty() ? "" : "; ") + std::string(error.what());
    }
  }
  return refusals;
}

}  // namespace

PickUpService::PickUpService(ros::NodeHandle& root, SimulationThread& simulation)
    : simulation_(simulation),
      server_(serveCommand(root, "warehouse/pick_up", &PickUpService::pickUp, this)) {}

bool PickUpService::pickUp(const warehouse_msgs::PickUp::Request& request,
                           warehouse_msgs::PickUp::Response& response) {
  return reply(response, [&] {
    std::string left;
    simulation_.change([&](kiva::World& world) {
      if (!request.item.empty()) return world.pickUp(request.item);
      left = pickUpAll(world);
    });
    return left;
  });
}

}  // namespace kiva_ros
