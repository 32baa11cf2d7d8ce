// SPDX-License-Identifier: Apache-2.0
#include "imu.h"

#include <cmath>

#include "ros/messages/convert.h"

namespace kiva_ros {
namespace {

bool calibrate(std_srvs::Empty::Request&, std_srvs::Empty::Response&) { return true; }

}  // namespace

void Imu::load(kiva::World& world, const std::string& model, const kiva::Parameters& p) {
  enter(world, model, p, "", "");
  link_ = link(p, "bodyName");
  const auto rpy = p.numbers("rpyOffset", {0, 0, 0});
  offset_ = kiva::Quaternion(rpy[0], rpy[1], rpy[2]);
  noise_ = p.number("gaussianNoise", 0, 0, 1e6);
  schedule_ = Schedule(p.number("updateRate", 0, 0, 1e6));
  imu_.header.frame_id = p.text("frameName", link_);
  for (auto* covariance : {&imu_.orientation_covariance, &imu_.angular_velocity_covariance,
                           &imu_.linear_acceleration_covariance}) {
    for (int i : {0, 4, 8}) (*covariance)[i] = noise_ * noise_;
  }
  skip(p, {"alwaysOn", "xyzOffset"});
  const std::string topic = p.text("topicName", "/default_imu");
  const std::string service = p.text("serviceName", "/default_imu");
  if (topic.empty()) return;
  publisher_ = node().advertise<sensor_msgs::Imu>(topic, 10);
  if (!service.empty()) calibration_ = node().advertiseService(service, calibrate);
}

void Imu::afterStep(const kiva::World& world, double) {
  if (!publisher_ || !schedule_.isDue(world.time())) return;
  const auto state = world.state(model(), link_);
  if (!state) return;
  const kiva::Quaternion rotation = (state->pose.Rot() * offset_).Normalized();
  const double passed = world.time() - measured_;
  kiva::Vector3 acceleration;
  if (measured_ >= 0 && passed > 0) {
    acceleration = (state->twist.linear - velocity_) / passed;
  }
  velocity_ = state->twist.linear;
  measured_ = world.time();
  if (publisher_.getNumSubscribers() == 0) return;
  const auto noisy = [&](kiva::Vector3 v, std::uint64_t index) {
    if (noise_ == 0) return v;
    for (int i = 0; i < 3; ++i) v[i] += noise_ * noise(seed(), world.steps(), index + i);
    return v;
  };
  sensor_msgs::Imu out = imu_;
  const std::string frame_id = imu_.header.frame_id;
  out.header = header(world.time(), frame_id);
  out.orientation = toMessage(kiva::Pose(kiva::Vector3::Zero, rotation)).orientation;
  out.angular_velocity = toMessage(noisy(rotation.RotateVectorReverse(state->twist.angular), 0));
  out.linear_acceleration = toMessage(noisy(rotation.RotateVectorReverse(acceleration), 3));
  publish(publisher_, std::move(out));
}

void Imu::reset(kiva::World&) { measured_ = -1; }

}  // namespace kiva_ros
