// SPDX-License-Identifier: Apache-2.0
#include "ros/services/simulation/simulation_services.h"

#include "ros/messages/convert.h"
#include "ros/services/base/service_answer.h"

namespace kiva_ros {

SimulationServices::SimulationServices(ros::NodeHandle& node, SimulationThread& simulation)
    : simulation_(simulation) {
  advertise(node, "pause_physics", [&simulation] { simulation.pause(true); });
  advertise(node, "unpause_physics", [&simulation] { simulation.pause(false); });
  advertise(node, "reset_simulation", [&simulation] { simulation.reset(true); });
  advertise(node, "reset_world", [&simulation] { simulation.reset(false); });
  servers_.push_back(
      node.advertiseService("get_world_properties", &SimulationServices::getWorld, this));
}

void SimulationServices::advertise(ros::NodeHandle& node, const std::string& name,
                                   const std::function<void()>& act) {
  using std_srvs::Empty;
  servers_.push_back(
      serveCommand<Empty::Request, Empty::Response>(node, name, [name, act](auto&, auto&) {
        try {
          act();
          return true;
        } catch (const std::exception& error) {  // Empty has no room for a status
          ROS_ERROR("%s: %s", name.c_str(), error.what());
          return false;
        }
      }));
}

bool SimulationServices::getWorld(gazebo_msgs::GetWorldProperties::Request&,
                                  gazebo_msgs::GetWorldProperties::Response& response) {
  return answer("GetWorldProperties", response, [&] {
    simulation_.run([&](kiva::World& world) {
      response.sim_time = world.time();
      response.model_names = world.modelNames();
    });
    response.rendering_enabled = false;
    return "GetWorldProperties: got properties";
  });
}

}  // namespace kiva_ros
