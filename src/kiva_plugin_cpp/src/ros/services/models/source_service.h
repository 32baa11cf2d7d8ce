// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>
#include <warehouse_msgs/WorldSources.h>

#include "ros/services/models/model_sources.h"
#include "ros/simulation/simulation_thread.h"

namespace kiva_ros {

/// Serves `/warehouse/sources`: the texts that the world's models come from, and their poses.
class SourceService {
 public:
  SourceService(ros::NodeHandle& root, SimulationThread& simulation, const ModelSources& sources);

 private:
  bool get(warehouse_msgs::WorldSources::Request& request,
           warehouse_msgs::WorldSources::Response& response);

  SimulationThread& simulation_;
  const ModelSources& sources_;
  ros::ServiceServer server_;
};

}  // namespace kiva_ros
