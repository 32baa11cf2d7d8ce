// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gazebo_msgs/DeleteModel.h>
#include <gazebo_msgs/SpawnModel.h>
#include <ros/ros.h>

#include <mutex>
#include <string>
#include <vector>

#include "kiva_plugin_cpp/world_file.h"
#include "ros/services/models/model_sources.h"
#include "ros/simulation/simulation_thread.h"

namespace kiva_ros {

/// Adds and removes models: spawn_sdf_model, spawn_urdf_model and delete_model of Gazebo's node.
class SpawnServices {
 public:
  SpawnServices(ros::NodeHandle& node, SimulationThread& simulation, kiva::ModelPaths model_paths,
                ModelSources& sources);

  /// The content of a request.
  struct Document {
    std::vector<kiva::ModelInstance> models;
    std::vector<WrittenModel> written;  ///< The models as the request's text has them.
    std::vector<kiva::Light> lights;
  };

 private:
  std::string spawn(const gazebo_msgs::SpawnModel::Request& request, const std::string& xml);
  bool remove(const gazebo_msgs::DeleteModel::Request& request,
              gazebo_msgs::DeleteModel::Response& response);
  Document parse(const gazebo_msgs::SpawnModel::Request& request, const std::string& xml);

  SimulationThread& simulation_;
  const kiva::ModelPaths model_paths_;
  ModelSources& sources_;
  std::mutex parsing_;  ///< Guards the parser's cache.
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace kiva_ros
