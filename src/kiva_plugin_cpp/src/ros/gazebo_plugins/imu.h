// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sensor_msgs/Imu.h>
#include <std_srvs/Empty.h>

#include <string>

#include "gazebo_plugin.h"

namespace kiva_ros {

/// libgazebo_ros_imu.so: how a link is turned, turns and gathers speed. As in Gazebo, the
/// acceleration is that of motion alone, without gravity.
class Imu : public GazeboPlugin {
 public:
  using GazeboPlugin::GazeboPlugin;
  void load(kiva::World& world, const std::string& model,
            const kiva::Parameters& parameters) override;
  void afterStep(const kiva::World& world, double dt) override;
  void reset(kiva::World& world) override;

 private:
  std::string link_;
  kiva::Quaternion offset_;
  double noise_ = 0;  ///< Standard deviation, of rates and accelerations alike.
  sensor_msgs::Imu imu_;
  kiva::Vector3 velocity_;  ///< At the last measurement, in world [m/s].
  double measured_ = -1;    ///< When that was [s], negative = never.
  Schedule schedule_;
  ros::Publisher publisher_;
  ros::ServiceServer calibration_;
};

}  // namespace kiva_ros
