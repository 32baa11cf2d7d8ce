// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <sensor_msgs/Imu.h>
#include <std_srvs/Empty.h>

#include <optional>
#include <string>

#include "kiva_plugin_cpp/world.h"

namespace kiva_ros {

/// The reading of an ideal IMU; rates and accelerations are in its own frame.
struct InertialReading {
  kiva::Quaternion rotation;  ///< Rotation in world.
  kiva::Vector3 turn;         ///< [rad/s]
  kiva::Vector3 motion;       ///< Acceleration of motion alone [m/s²].
  kiva::Vector3 gravity;      ///< Specific force of support: upwards at rest [m/s²].
};

/// A frame fixed to a link, whose acceleration follows from its velocity at two times.
class InertialFrame {
 public:
  InertialFrame() = default;
  InertialFrame(std::string link, const kiva::Pose& pose_in_link)
      : link_(std::move(link)), pose_in_link_(pose_in_link) {}

  /// Measures since the last call. Returns nothing if the link was deleted.
  std::optional<InertialReading> measure(const kiva::World& world, const std::string& model);
  void reset() { measured_ = -1; }

 private:
  std::string link_;
  kiva::Pose pose_in_link_;
  kiva::Vector3 velocity_;  ///< Velocity at the last measurement, in world [m/s].
  double measured_ = -1;    ///< Time of that measurement [s], negative = never.
};

/// Sets the three diagonals to the square of a deviation.
void setCovariance(double deviation, boost::array<double, 9>* covariance);

/// Returns `imu` with its measurements replaced by a reading.
sensor_msgs::Imu filled(const sensor_msgs::Imu& imu, double time, const kiva::Quaternion& rotation,
                        const kiva::Vector3& turn, const kiva::Vector3& acceleration);

/// Serves an IMU's calibration, which does nothing here.
bool calibrateImu(std_srvs::Empty::Request&, std_srvs::Empty::Response&);

}  // namespace kiva_ros
