// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "ros/gazebo_plugins/base/gazebo_plugin.h"

namespace kiva_ros {

/// Stands in for libgazebo_ros_ft_sensor.so: publishes the force and torque on a joint in the frame
/// of the joint's child link, about that link's origin.
class FtSensor : public GazeboPlugin {
 public:
  using GazeboPlugin::GazeboPlugin;
  void load(kiva::World& world, const std::string& model,
            const kiva::Parameters& parameters) override;
  void afterStep(const kiva::World& world, double dt) override;

 private:
  std::string joint_, child_;
  double noise_ = 0;  ///< Standard deviation [N, Nm].
  Schedule schedule_;
  ros::Publisher publisher_;
};

}  // namespace kiva_ros
