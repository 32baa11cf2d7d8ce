// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sensor_msgs/PointCloud.h>

#include <string>
#include <vector>

#include "ros/gazebo_plugins/base/gazebo_plugin.h"
#include "ros/gazebo_plugins/rays/ray_grid.h"

namespace kiva_ros {

/// Stands in for libgazebo_ros_block_laser.so in a <sensor type="ray"> of several layers: publishes
/// a point a ray, as a sensor_msgs/PointCloud in the sensor's frame. As in Gazebo, a ray without
/// return ends at its full range.
class BlockLaser : public GazeboPlugin {
 public:
  using GazeboPlugin::GazeboPlugin;
  void load(kiva::World& world, const std::string& model,
            const kiva::Parameters& parameters) override;
  void afterStep(const kiva::World& world, double dt) override;

 private:
  std::string link_, frame_;
  kiva::Pose pose_in_link_;
  double max_range_ = 0;  ///< [m]
  double noise_ = 0;      ///< Standard deviation along each axis [m].
  std::vector<kiva::Vector3> directions_;
  Schedule schedule_;
  ros::Publisher publisher_;
};

}  // namespace kiva_ros
