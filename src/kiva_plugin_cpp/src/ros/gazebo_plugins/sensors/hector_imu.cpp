// SPDX-License-Identifier: Apache-2.0
#include "ros/gazebo_plugins/sensors/hector_imu.h"

#include <iterator>
#include <sstream>

namespace kiva_ros {
namespace {

/// Reads three numbers, or one for all three axes.
kiva::Vector3 readAxes(const kiva::Parameters& p, const std::string& key) {
  std::istringstream words(p.text(key, "0"));
  const auto count = std::distance(std::istream_iterator<std::string>(words), {});
  if (count == 1) return kiva::Vector3::One * p.number(key, 0, -1e6, 1e6);
  const auto axes = p.numbers(key, {0, 0, 0});
  return {axes[0], axes[1], axes[2]};
}

void setCovariance(const kiva::Vector3& deviation, boost::array<double, 9>* covariance) {
  for (int i = 0; i < 3; ++i) (*covariance)[4 * i] = deviation[i] * deviation[i];
}

}  // namespace

HectorImu::Error HectorImu::readError(kiva::World& world, const kiva::Parameters& p,
                                      const std::string& prefix) {
  constexpr double kNoDrift = 1e-3;  // [m/s², rad/s]
  if (!readAxes(p, prefix + "Drift").Equal(kiva::Vector3::Zero, kNoDrift)) {
    world.warn(p.where() + ": <" + prefix + "Drift> is left out: biases do not drift here");
  }
  skip(p, {(prefix + "DriftFrequency").c_str()});
  return {readAxes(p, prefix + "Offset"), readAxes(p, prefix + "GaussianNoise")};
}

void HectorImu::load(kiva::World& world, const std::string& model, const kiva::Parameters& p) {
  enter(world, model, p, "", "");
  if (description().links.empty()) throw kiva::DescriptionError("'" + model + "' has no links");
  const std::string body =
      p.has("bodyName") ? link(p, "bodyName") : description().links.front().name;
  frame_ = InertialFrame(body, kiva::Pose::Zero);
  imu_.header.frame_id = p.text(p.has("frameId") ? "frameId" : "frameName", body);
  acceleration_ = readError(world, p, "accel");
  rate_ = readError(world, p, "rate");
  heading_ = readError(world, p, "heading");
  if (const double noise = p.number("gaussianNoise", 0, 0, 1e6); noise > 0) {
    acceleration_.noise = rate_.noise = kiva::Vector3::One * noise;
  }
  // Models an accelerometer that is mounted with small tilts, as that plugin does.
  const auto rpy = p.numbers("rpyOffset", {0, 0, 0});
  acceleration_.offset += kiva::Vector3(rpy[1], -rpy[0], 0) * 9.8065;
  heading_.offset.Z() += rpy[2];
  setCovariance(acceleration_.noise, &imu_.linear_acceleration_covariance);
  setCovariance(rate_.noise, &imu_.angular_velocity_covariance);
  imu_.orientation_covariance[8] = heading_.noise.Z() * heading_.noise.Z();
  schedule_ = Schedule(p.number("updateRate", 0, 0, 1e6));
  skip(p, {"alwaysOn", "xyzOffset", "randomEngineSeed"});
  const std::string topic = p.text("topicName", "imu");
  publisher_ = advertise<sensor_msgs::Imu>(topic);
  const std::string service = p.text("serviceName", topic + "/calibrate");
  if (!service.empty()) calibration_ = node().advertiseService(service, calibrateImu);
}

kiva::Vector3 HectorImu::disturbed(const kiva::World& world, const kiva::Vector3& vector,
                                   const Error& error, std::uint64_t index) const {
  const kiva::Vector3 sample = noisy(world, kiva::Vector3::Zero, 1, index);
  return vector + error.offset + error.noise * sample;
}

void HectorImu::afterStep(const kiva::World& world, double) {
  if (!schedule_.isDue(world.time())) return;
  const auto reading = frame_.measure(world, model());
  if (!reading || publisher_.getNumSubscribers() == 0) return;
  const double heading = disturbed(world, kiva::Vector3::Zero, heading_, 6).Z();
  publish(publisher_,
          filled(imu_, world.time(), reading->rotation * kiva::Quaternion(0, 0, heading),
                 disturbed(world, reading->turn, rate_, 0),
                 disturbed(world, reading->motion + reading->gravity, acceleration_, 3)));
}

void HectorImu::reset(kiva::World&) { frame_.reset(); }

}  // namespace kiva_ros
