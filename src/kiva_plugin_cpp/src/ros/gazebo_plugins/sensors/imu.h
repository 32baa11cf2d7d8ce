// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sensor_msgs/Imu.h>

#include <string>

#include "ros/gazebo_plugins/base/gazebo_plugin.h"
#include "ros/gazebo_plugins/sensors/inertial_frame.h"

namespace kiva_ros {

/// Stands in for libgazebo_ros_imu.so: publishes a link's orientation, rates and acceleration. As
/// in Gazebo, the acceleration is that of motion alone, without gravity.
class Imu : public GazeboPlugin {
 public:
  using GazeboPlugin::GazeboPlugin;
  void load(kiva::World& world, const std::string& model,
            const kiva::Parameters& parameters) override;
  void afterStep(const kiva::World& world, double dt) override;
  void reset(kiva::World& world) override;

 private:
  InertialFrame frame_;
  double noise_ = 0;  ///< Standard deviation, of rates and accelerations alike.
  sensor_msgs::Imu imu_;
  Schedule schedule_;
  ros::Publisher publisher_;
  ros::ServiceServer calibration_;
};

}  // namespace kiva_ros
