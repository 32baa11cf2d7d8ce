// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>
#include <warehouse_msgs/LightCurtain.h>
#include <warehouse_msgs/Person.h>

#include "kiva_plugin_cpp/world_file.h"
#include "ros/simulation/simulation_thread.h"

namespace kiva_ros {

/// Serves `/warehouse/person` and `/warehouse/light_curtain`: the walks of people, and the zones in
/// which robots stop for them.
class PeopleServices {
 public:
  PeopleServices(ros::NodeHandle& root, SimulationThread& simulation, kiva::ModelPaths model_paths);

 private:
  bool walk(const warehouse_msgs::Person::Request& request,
            warehouse_msgs::Person::Response& response);
  bool setCurtain(const warehouse_msgs::LightCurtain::Request& request,
                  warehouse_msgs::LightCurtain::Response& response);

  SimulationThread& simulation_;
  const kiva::ModelPaths model_paths_;
  ros::ServiceServer person_, light_curtain_;
};

}  // namespace kiva_ros
