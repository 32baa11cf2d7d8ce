// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sensor_msgs/PointCloud2.h>

#include <string>
#include <vector>

#include "ros/gazebo_plugins/base/gazebo_plugin.h"
#include "ros/gazebo_plugins/rays/ray_grid.h"

namespace kiva_ros {

/// Stands in for libgazebo_ros_velodyne_laser.so in a <sensor type="ray"> of several layers:
/// publishes the returns of a whole turn with their rings, as a sensor_msgs/PointCloud2 in the
/// sensor's frame.
class VelodyneLaser : public GazeboPlugin {
 public:
  using GazeboPlugin::GazeboPlugin;
  void load(kiva::World& world, const std::string& model,
            const kiva::Parameters& parameters) override;
  void afterStep(const kiva::World& world, double dt) override;

 private:
  std::string link_, frame_;
  kiva::Pose pose_in_link_;
  RayGrid grid_;
  std::vector<kiva::Vector3> directions_;
  double min_range_ = 0, max_range_ = 0;  ///< [m]
  double noise_ = 0;                      ///< Standard deviation [m].
  bool is_organized_ = false;  ///< Whether there is a point for every ray, NaN without return, and
                               ///< a row for every ring.
  Schedule schedule_;
  ros::Publisher publisher_;
};

}  // namespace kiva_ros
