// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>
#include <warehouse_msgs/FleetPaths.h>
#include <warehouse_msgs/Scenery.h>

#include <atomic>
#include <cstdint>
#include <limits>

#include "engine.h"

namespace kiva_ros {

/// What only a picture of the warehouse needs: /warehouse/scenery and /warehouse/paths, by the wall
/// clock, also while time stands still. Costs nothing while nobody listens.
class Showcase {
 public:
  Showcase(ros::NodeHandle& root, Engine& engine);

 private:
  void publish();
  void publishScenery();
  void publishPaths();

  Engine& engine_;
  std::atomic<bool> newcomer_{false};  ///< Somebody came who has seen no scenery yet.
  warehouse_msgs::Scenery scenery_;    ///< As last looked at,
  std::uint64_t models_revision_ =
      std::numeric_limits<std::uint64_t>::max();  ///< at that revision.
  ros::Publisher scenery_topic_, paths_topic_;
  ros::WallTimer timer_;
};

warehouse_msgs::Scenery sceneryOf(const kiva::World& world);
/// Brings its poses and its time up to date while no model comes or goes. Whether any moved.
bool updatePoses(const kiva::World& world, warehouse_msgs::Scenery* scenery);
warehouse_msgs::FleetPaths pathsOf(const kiva::World& world);

}  // namespace kiva_ros
