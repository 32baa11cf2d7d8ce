// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sensor_msgs/LaserScan.h>

#include <string>
#include <vector>

#include "ros/gazebo_plugins/base/gazebo_plugin.h"
#include "ros/gazebo_plugins/rays/ray_grid.h"

namespace kiva_ros {

/// Stands in for libgazebo_ros_laser.so in a <sensor type="ray">: publishes a scan in the sensor's
/// plane; rays pass through the sensor's own model.
class Laser : public GazeboPlugin {
 public:
  using GazeboPlugin::GazeboPlugin;
  void load(kiva::World& world, const std::string& model,
            const kiva::Parameters& parameters) override;
  void afterStep(const kiva::World& world, double dt) override;

 private:
  std::vector<double> cast(const kiva::World& world, const kiva::Pose& pose) const;

  std::string link_;
  kiva::Pose pose_in_link_;
  sensor_msgs::LaserScan scan_;  ///< All but the ranges and the time.
  RayGrid grid_;
  std::vector<kiva::Vector3> directions_;  ///< In the sensor's frame.
  Schedule schedule_;
  ros::Publisher publisher_;
};

}  // namespace kiva_ros
