// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sensor_msgs/Imu.h>

#include <string>

#include "ros/gazebo_plugins/base/gazebo_plugin.h"
#include "ros/gazebo_plugins/sensors/inertial_frame.h"

namespace kiva_ros {

/// Stands in for libhector_gazebo_ros_imu.so: publishes an IMU of a link, with gravity in its
/// acceleration, constant offsets and noise. Its biases do not drift.
class HectorImu : public GazeboPlugin {
 public:
  using GazeboPlugin::GazeboPlugin;
  void load(kiva::World& world, const std::string& model,
            const kiva::Parameters& parameters) override;
  void afterStep(const kiva::World& world, double dt) override;
  void reset(kiva::World& world) override;

 private:
  /// The error of a quantity, axis by axis: a constant and a standard deviation.
  struct Error {
    kiva::Vector3 offset, noise;
  };
  static Error readError(kiva::World& world, const kiva::Parameters& parameters,
                         const std::string& prefix);
  kiva::Vector3 disturbed(const kiva::World& world, const kiva::Vector3& vector, const Error& error,
                          std::uint64_t index) const;

  InertialFrame frame_;
  Error acceleration_, rate_, heading_;
  sensor_msgs::Imu imu_;
  Schedule schedule_;
  ros::Publisher publisher_;
  ros::ServiceServer calibration_;
};

}  // namespace kiva_ros
