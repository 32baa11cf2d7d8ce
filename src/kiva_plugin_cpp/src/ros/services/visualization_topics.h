// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>

#include <atomic>
#include <cstdint>
#include <limits>

#include "ros/publishing/scenery.h"
#include "ros/simulation/simulation_thread.h"

namespace kiva_ros {

/// What only a picture of the warehouse needs: /warehouse/scenery and /warehouse/paths, by the wall
/// clock, also while time stands still. Costs nothing while nobody listens.
class VisualizationTopics {
 public:
  VisualizationTopics(ros::NodeHandle& root, SimulationThread& simulation);

 private:
  void publish();
  void publishScenery();
  void publishPaths();

  SimulationThread& simulation_;
  std::atomic<bool> newcomer_{false};  ///< Somebody came who has seen no scenery yet.
  warehouse_msgs::Scenery scenery_;    ///< As last looked at,
  std::uint64_t models_revision_ =
      std::numeric_limits<std::uint64_t>::max();  ///< at that revision.
  ros::Publisher scenery_topic_, paths_topic_;
  ros::WallTimer timer_;
};

}  // namespace kiva_ros
