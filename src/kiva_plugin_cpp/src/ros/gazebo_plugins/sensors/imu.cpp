// SPDX-License-Identifier: Apache-2.0
#include "ros/gazebo_plugins/sensors/imu.h"

namespace kiva_ros {
void Imu::load(kiva::World& world, const std::string& model, const kiva::Parameters& p) {
  enter(world, model, p, "", "");
  const std::string body = link(p, "bodyName");
  const auto rpy = p.numbers("rpyOffset", {0, 0, 0});
  frame_ = InertialFrame(body, kiva::Pose(0, 0, 0, rpy[0], rpy[1], rpy[2]));
  noise_ = p.number("gaussianNoise", 0, 0, 1e6);
  schedule_ = Schedule(p.number("updateRate", 0, 0, 1e6));
  imu_.header.frame_id = p.text("frameName", body);
  for (auto* covariance : {&imu_.orientation_covariance, &imu_.angular_velocity_covariance,
                           &imu_.linear_acceleration_covariance}) {
    setCovariance(noise_, covariance);
  }
  skip(p, {"alwaysOn", "xyzOffset"});
  const std::string topic = p.text("topicName", "/default_imu");
  const std::string service = p.text("serviceName", "/default_imu");
  if (topic.empty()) return;
  publisher_ = advertise<sensor_msgs::Imu>(topic);
  if (!service.empty()) calibration_ = node().advertiseService(service, calibrateImu);
}

void Imu::afterStep(const kiva::World& world, double) {
  if (!publisher_ || !schedule_.isDue(world.time())) return;
  const auto reading = frame_.measure(world, model());
  if (!reading || publisher_.getNumSubscribers() == 0) return;
  publish(publisher_,
          filled(imu_, world.time(), reading->rotation, noisy(world, reading->turn, noise_, 0),
                 noisy(world, reading->motion, noise_, 3)));
}

void Imu::reset(kiva::World&) { frame_.reset(); }

}  // namespace kiva_ros
