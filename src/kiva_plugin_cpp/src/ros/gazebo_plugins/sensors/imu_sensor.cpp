// SPDX-License-Identifier: Apache-2.0
#include "ros/gazebo_plugins/sensors/imu_sensor.h"

#include <cmath>

namespace kiva_ros {

void ImuSensor::load(kiva::World& world, const std::string& model, const kiva::Parameters& p) {
  enter(world, model, p, model, model);
  const kiva::SensorDescription& from = sensor(p, "imu");
  frame_ = InertialFrame(from.link, from.pose_in_link);
  imu_.header.frame_id = required(p, "frameName");
  const auto rpy = p.numbers("rpyOffset", {0, 0, 0});
  offset_ = kiva::Quaternion(rpy[0], rpy[1], rpy[2]);
  if (p.flag("initialOrientationAsReference", false)) {
    offset_ =
        offset_ * (world.state(model, from.link)->pose.Rot() * from.pose_in_link.Rot()).Inverse();
  }
  // The plugin's noise is on top of the sensor's own.
  const double noise = p.number("gaussianNoise", 0, 0, 1e6);
  const auto deviation = [&](const char* of) {
    const double own =
        from.parameters.number("imu/" + std::string(of) + "/x/noise/stddev", 0, 0, 1e6);
    return std::hypot(noise, own);
  };
  rotation_noise_ = noise;
  turn_noise_ = deviation("angular_velocity");
  motion_noise_ = deviation("linear_acceleration");
  setCovariance(rotation_noise_, &imu_.orientation_covariance);
  setCovariance(turn_noise_, &imu_.angular_velocity_covariance);
  setCovariance(motion_noise_, &imu_.linear_acceleration_covariance);
  schedule_ = Schedule(slower(p.number("updateRateHZ", 1, 0, 1e6), from.update_rate));
  skip(p, {"alwaysOn", "xyzOffset", "updateRate", "bodyName", "serviceName"});
  publisher_ = advertise<sensor_msgs::Imu>(p.text("topicName", "imu_data"));
}

void ImuSensor::afterStep(const kiva::World& world, double) {
  if (!schedule_.isDue(world.time())) return;
  const auto reading = frame_.measure(world, model());
  if (!reading || publisher_.getNumSubscribers() == 0) return;
  const kiva::Vector3 wrong = noisy(world, kiva::Vector3::Zero, rotation_noise_, 6);
  const kiva::Quaternion rotation =
      offset_ * reading->rotation * kiva::Quaternion(wrong.X(), wrong.Y(), wrong.Z());
  publish(publisher_, filled(imu_, world.time(), rotation.Normalized(),
                             noisy(world, reading->turn, turn_noise_, 0),
                             noisy(world, reading->motion + reading->gravity, motion_noise_, 3)));
}

void ImuSensor::reset(kiva::World&) { frame_.reset(); }

}  // namespace kiva_ros
