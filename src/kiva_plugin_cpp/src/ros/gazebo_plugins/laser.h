// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sensor_msgs/LaserScan.h>

#include <string>

#include "gazebo_plugin.h"

namespace kiva_ros {

/// libgazebo_ros_laser.so in a <sensor type="ray">: a level scan at the sensor's height, which its
/// own model does not show up in.
class Laser : public GazeboPlugin {
 public:
  using GazeboPlugin::GazeboPlugin;
  void load(kiva::World& world, const std::string& model,
            const kiva::Parameters& parameters) override;
  void afterStep(const kiva::World& world, double dt) override;

 private:
  std::string link_;
  kiva::Pose pose_in_link_;
  sensor_msgs::LaserScan scan_;  ///< All but the ranges and the time.
  int rays_ = 0;
  double least_ = 0, most_ = 0;  ///< Angles [rad].
  double noise_ = 0;             ///< Standard deviation [m].
  Schedule schedule_;
  ros::Publisher publisher_;
};

}  // namespace kiva_ros
