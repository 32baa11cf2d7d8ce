// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sensor_msgs/Imu.h>
#include <std_srvs/Empty.h>

#include <optional>
#include <string>

#include "kiva_plugin_cpp/world.h"

namespace kiva_ros {

/// What an ideal IMU feels; rates and accelerations in its own frame.
struct InertialReading {
  kiva::Quaternion rotation;  ///< In world.
  kiva::Vector3 turn;         ///< [rad/s]
  kiva::Vector3 motion;       ///< Acceleration of motion alone [m/s²].
  kiva::Vector3 gravity;      ///< What holds it against gravity: upwards at rest [m/s²].
};

/// A frame fixed to a link, whose acceleration follows from its velocity at two times.
class InertialFrame {
 public:
  InertialFrame() = default;
  InertialFrame(std::string link, const kiva::Pose& pose_in_link)
      : link_(std::move(link)), pose_in_link_(pose_in_link) {}

  /// Now, since the last call. Nothing if the link is gone.
  std::optional<InertialReading> measure(const kiva::World& world, const std::string& model);
  void reset() { measured_ = -1; }

 private:
  std::string link_;
  kiva::Pose pose_in_link_;
  kiva::Vector3 velocity_;  ///< At the last measurement, in world [m/s].
  double measured_ = -1;    ///< When that was [s], negative = never.
};

/// Sets the three diagonals to the square of a deviation.
void setCovariance(double deviation, boost::array<double, 9>* covariance);

/// `imu` with a reading in place of its measurements.
sensor_msgs::Imu filled(const sensor_msgs::Imu& imu, double time, const kiva::Quaternion& rotation,
                        const kiva::Vector3& turn, const kiva::Vector3& acceleration);

/// The service that users of an IMU call before they trust it: this one always is calibrated.
bool calibrateImu(std_srvs::Empty::Request&, std_srvs::Empty::Response&);

}  // namespace kiva_ros
