// SPDX-License-Identifier: Apache-2.0
#include "ros/gazebo_plugins/sensors/inertial_frame.h"

#include "ros/messages/convert.h"

namespace kiva_ros {

std::optional<InertialReading> InertialFrame::measure(const kiva::World& world,
                                                      const std::string& model) {
  const auto state = world.state(model, link_);
  if (!state) return std::nullopt;
  const kiva::Vector3 arm = state->pose.Rot() * pose_in_link_.Pos();
  const kiva::Vector3 velocity = state->twist.linear + state->twist.angular.Cross(arm);
  const double passed = world.time() - measured_;
  kiva::Vector3 acceleration;
  if (measured_ >= 0 && passed > 0) acceleration = (velocity - velocity_) / passed;
  velocity_ = velocity;
  measured_ = world.time();

  InertialReading out;
  out.rotation = (state->pose.Rot() * pose_in_link_.Rot()).Normalized();
  out.turn = out.rotation.RotateVectorReverse(state->twist.angular);
  out.motion = out.rotation.RotateVectorReverse(acceleration);
  out.gravity = out.rotation.RotateVectorReverse(-world.gravity());
  return out;
}

void setCovariance(double deviation, boost::array<double, 9>* covariance) {
  for (int i : {0, 4, 8}) (*covariance)[i] = deviation * deviation;
}

sensor_msgs::Imu filled(const sensor_msgs::Imu& imu, double time, const kiva::Quaternion& rotation,
                        const kiva::Vector3& turn, const kiva::Vector3& acceleration) {
  sensor_msgs::Imu out = imu;
  const std::string frame_id = imu.header.frame_id;
  out.header = header(time, frame_id);
  out.orientation = toMessage(kiva::Pose(kiva::Vector3::Zero, rotation)).orientation;
  out.angular_velocity = toMessage(turn);
  out.linear_acceleration = toMessage(acceleration);
  return out;
}

bool calibrateImu(std_srvs::Empty::Request&, std_srvs::Empty::Response&) { return true; }

}  // namespace kiva_ros
