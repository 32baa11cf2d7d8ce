// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nav_msgs/Odometry.h>

#include <string>

#include "ros/gazebo_plugins/base/gazebo_plugin.h"

namespace kiva_ros {

/// Stands in for libgazebo_ros_p3d.so: publishes the true pose and velocity of a link, in world or
/// relative to another link.
class P3d : public GazeboPlugin {
 public:
  using GazeboPlugin::GazeboPlugin;
  void load(kiva::World& world, const std::string& model,
            const kiva::Parameters& parameters) override;
  void afterStep(const kiva::World& world, double dt) override;

 private:
  std::string link_;
  std::string reference_;  ///< A link of the model, empty = world.
  kiva::Pose offset_;
  double noise_ = 0;            ///< Standard deviation of velocities.
  nav_msgs::Odometry message_;  ///< All but what is measured.
  Schedule schedule_;
  ros::Publisher publisher_;
};

}  // namespace kiva_ros
