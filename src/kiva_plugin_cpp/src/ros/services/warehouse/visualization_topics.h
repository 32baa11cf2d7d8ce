// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>

#include <atomic>
#include <cstdint>
#include <limits>

#include "ros/publishing/scenery.h"
#include "ros/simulation/simulation_thread.h"

namespace kiva_ros {

/// Publishes /warehouse/scenery and /warehouse/paths, which only viewers need, by the wall clock,
/// also while time stands still. Without subscribers it costs nothing.
class VisualizationTopics {
 public:
  VisualizationTopics(ros::NodeHandle& root, SimulationThread& simulation);

 private:
  void publish();
  void publishScenery();
  void publishPaths();

  SimulationThread& simulation_;
  std::atomic<bool> newcomer_{false};  ///< A new subscriber waits for the scenery.
  warehouse_msgs::Scenery scenery_;    ///< The scenery of
  std::uint64_t models_revision_ =
      std::numeric_limits<std::uint64_t>::max();  ///< this revision of the models.
  ros::Publisher scenery_topic_, paths_topic_;
  ros::WallTimer timer_;
};

}  // namespace kiva_ros
