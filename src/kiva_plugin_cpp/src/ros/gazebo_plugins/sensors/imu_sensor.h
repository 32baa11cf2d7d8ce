// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sensor_msgs/Imu.h>

#include <string>

#include "ros/gazebo_plugins/base/gazebo_plugin.h"
#include "ros/gazebo_plugins/sensors/inertial_frame.h"

namespace kiva_ros {

/// Stands in for libgazebo_ros_imu_sensor.so in a <sensor type="imu">; its acceleration is the
/// specific force, upwards at rest.
class ImuSensor : public GazeboPlugin {
 public:
  using GazeboPlugin::GazeboPlugin;
  void load(kiva::World& world, const std::string& model,
            const kiva::Parameters& parameters) override;
  void afterStep(const kiva::World& world, double dt) override;
  void reset(kiva::World& world) override;

 private:
  InertialFrame frame_;
  kiva::Quaternion offset_;    ///< Rotation that precedes the orientation.
  double turn_noise_ = 0;      ///< Standard deviations [rad/s].
  double motion_noise_ = 0;    ///< [m/s²]
  double rotation_noise_ = 0;  ///< [rad]
  sensor_msgs::Imu imu_;
  Schedule schedule_;
  ros::Publisher publisher_;
};

}  // namespace kiva_ros
