// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gazebo_msgs/GetModelProperties.h>
#include <gazebo_msgs/GetModelState.h>
#include <gazebo_msgs/SetModelState.h>
#include <ros/ros.h>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "ros/simulation/simulation_thread.h"

namespace kiva_ros {

/// Serves the states of models: get_model_state (at the root as well), get_model_properties,
/// set_model_state and its topic.
class StateServices {
 public:
  StateServices(ros::NodeHandle& root, ros::NodeHandle& node, SimulationThread& simulation);

 private:
  bool getModel(gazebo_msgs::GetModelState::Request& request,
                gazebo_msgs::GetModelState::Response& response);
  bool getProperties(gazebo_msgs::GetModelProperties::Request& request,
                     gazebo_msgs::GetModelProperties::Response& response);
  bool setModel(const gazebo_msgs::SetModelState::Request& request,
                gazebo_msgs::SetModelState::Response& response);
  void setModelByTopic(const gazebo_msgs::ModelState& state);

  SimulationThread& simulation_;
  std::map<std::string, std::uint32_t>
      asked_;  ///< Number of requests by model; used by the step thread alone.
  std::vector<ros::ServiceServer> servers_;
  ros::Subscriber set_model_;
};

}  // namespace kiva_ros
