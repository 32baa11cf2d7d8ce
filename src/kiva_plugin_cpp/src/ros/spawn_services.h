// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gazebo_msgs/DeleteModel.h>
#include <gazebo_msgs/SpawnModel.h>
#include <ros/ros.h>

#include <mutex>
#include <vector>

#include "engine.h"
#include "kiva_plugin_cpp/world_file.h"

namespace kiva_ros {

/// Models come and go: spawn_sdf_model and delete_model of Gazebo's node.
class SpawnServices {
 public:
  SpawnServices(ros::NodeHandle& node, Engine& engine, kiva::ModelPaths model_paths);

 private:
  bool spawn(gazebo_msgs::SpawnModel::Request& request,
             gazebo_msgs::SpawnModel::Response& response);
  bool remove(gazebo_msgs::DeleteModel::Request& request,
              gazebo_msgs::DeleteModel::Response& response);
  std::vector<kiva::ModelInstance> parse(const gazebo_msgs::SpawnModel::Request& request);

  Engine& engine_;
  const kiva::ModelPaths model_paths_;
  std::mutex parsing_;  ///< The parser's cache is for one thread at a time.
  std::vector<ros::ServiceServer> servers_;
};

}  // namespace kiva_ros
