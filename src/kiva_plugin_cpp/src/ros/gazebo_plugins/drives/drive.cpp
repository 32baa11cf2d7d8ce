// SPDX-License-Identifier: Apache-2.0
#include "ros/gazebo_plugins/drives/drive.h"

#include <nav_msgs/Odometry.h>
#include <tf2_msgs/TFMessage.h>

#include <cmath>

#include "ros/gazebo_plugins/base/saved_numbers.h"
#include "ros/messages/convert.h"

namespace kiva_ros {

DrivePlugin::~DrivePlugin() {
  for (const std::string& name : {odometry_frame_, base_frame_}) {
    const auto at = frames().find(name);
    if (at != frames().end() && at->second.plugin == this) frames().erase(at);
  }
}

void DrivePlugin::claimFrames(kiva::World& world) {
  for (const std::string& name : {odometry_frame_, base_frame_}) {
    const auto at = frames().find(name);
    if (at == frames().end() || at->second.model == model()) continue;
    prefix_ = model() + "/";
    world.warn("'" + model() + "' has the frames of '" + at->second.model + "', " +
               odometry_frame_ + " and " + base_frame_ + ": here they are " + prefix_ +
               odometry_frame_ + " and " + prefix_ + base_frame_ +
               "; the parameter tf_prefix in its namespace names others");
    break;
  }
  for (std::string* name : {&odometry_frame_, &base_frame_}) {
    *name = prefix_ + *name;
    frames()[*name] = {model(), this};
  }
}

void DrivePlugin::openTopics(kiva::World& world, const kiva::Parameters& p) {
  odometry_frame_ = frame(p.text("odometryFrame", "odom"));
  base_frame_ = frame(p.text("robotBaseFrame", "base_footprint"));
  claimFrames(world);
  odometry_ = advertise<nav_msgs::Odometry>(p.text("odometryTopic", "odom"));
  transforms_ = advertise<tf2_msgs::TFMessage>(shared("tf"), 100);
  commands_ = subscribe<geometry_msgs::Twist>(p.text("commandTopic", "cmd_vel"));
}

bool DrivePlugin::takeCommand() {
  const geometry_msgs::Twist* message = commands_.take();
  if (!message) return false;
  const double x = message->linear.x, y = message->linear.y, turn = message->angular.z;
  if (!std::isfinite(x) || !std::isfinite(y) || !std::isfinite(turn)) return false;
  command_ = {bounded(x, kMost), bounded(y, kMost), bounded(turn, kMost)};
  return true;
}

kiva::EntityState DrivePlugin::trueOdometry(const kiva::World& world) const {
  kiva::EntityState out = *world.state(model());
  const kiva::Quaternion heading(0, 0, out.pose.Rot().Yaw());
  const kiva::Vector3 local = heading.RotateVectorReverse(out.twist.linear);
  out.twist = {{local.X(), local.Y(), 0}, {0, 0, out.twist.angular.Z()}};
  return out;
}

void DrivePlugin::publishOdometry(const kiva::World& world, const kiva::EntityState& state) {
  constexpr double kUnknown =
      1e12;  // covariance that Gazebo's plugins give for unmeasured quantities
  nav_msgs::Odometry out;
  out.header = header(world.time(), odometry_frame_);
  out.child_frame_id = base_frame_;
  out.pose.pose = toMessage(state.pose);
  out.twist.twist = toMessage(state.twist);
  const double diagonal[] = {covariance_.x, covariance_.y, kUnknown,
                             kUnknown,      kUnknown,      covariance_.yaw};
  for (int i = 0; i < 6; ++i) out.pose.covariance[7 * i] = diagonal[i];
  publish(odometry_, out);
}

void DrivePlugin::publishOdometryTransform(const kiva::World& world,
                                           const kiva::EntityState& state) {
  tf2_msgs::TFMessage tf;
  tf.transforms.push_back(transform(world.time(), odometry_frame_, base_frame_, state.pose));
  publish(transforms_, tf);
}

}  // namespace kiva_ros
