// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sensor_msgs/Range.h>

#include <string>
#include <vector>

#include "ros/gazebo_plugins/base/gazebo_plugin.h"
#include "ros/gazebo_plugins/rays/ray_grid.h"

namespace kiva_ros {

/// Stands in for libgazebo_ros_range.so in a <sensor type="ray">: publishes the nearest distance
/// that any of its rays meets.
class Range : public GazeboPlugin {
 public:
  using GazeboPlugin::GazeboPlugin;
  void load(kiva::World& world, const std::string& model,
            const kiva::Parameters& parameters) override;
  void afterStep(const kiva::World& world, double dt) override;

 private:
  std::string link_;
  kiva::Pose pose_in_link_;
  std::vector<kiva::Vector3> directions_;
  sensor_msgs::Range range_;  ///< All but the range and the time.
  double noise_ = 0;          ///< Standard deviation [m].
  Schedule schedule_;
  ros::Publisher publisher_;
};

}  // namespace kiva_ros
