// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gazebo_msgs/DeleteModel.h>
#include <gazebo_msgs/SpawnModel.h>
#include <ros/ros.h>

#include <mutex>
#include <vector>

#include "kiva_plugin_cpp/world_file.h"
#include "ros/simulation/simulation_thread.h"

namespace kiva_ros {

/// Adds and removes models: spawn_sdf_model, spawn_urdf_model and delete_model of Gazebo's node.
class SpawnServices {
 public:
  SpawnServices(ros::NodeHandle& node, SimulationThread& simulation, kiva::ModelPaths model_paths);

  /// The content of a request.
  struct Document {
    std::vector<kiva::ModelInstance> models;
    std::vector<kiva::Light> lights;
  };

 private:
  std::string spawn(const gazebo_msgs::SpawnModel::Request& request, const std::string& xml);
  bool remove(gazebo_msgs::DeleteModel::Request& request,
              gazebo_msgs::DeleteModel::Response& response);
  Document parse(const gazebo_msgs::SpawnModel::Request& request, const std::string& xml);

  SimulationThread& simulation_;
  const kiva::ModelPaths model_paths_;
  std::mutex parsing_;  ///< Guards the parser's cache.
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace kiva_ros
