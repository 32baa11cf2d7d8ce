// SPDX-License-Identifier: Apache-2.0
#include "ros/gazebo_plugins/sensors/p3d.h"

#include "ros/messages/convert.h"

namespace kiva_ros {
namespace {

bool isWorld(const std::string& frame) {
  return frame == "world" || frame == "/world" || frame == "map" || frame == "/map";
}

}  // namespace

void P3d::load(kiva::World& world, const std::string& model, const kiva::Parameters& p) {
  enter(world, model, p, "", "");
  link_ = link(p, "bodyName");
  const std::string frame_name = p.text("frameName", "world");
  if (!isWorld(frame_name)) reference_ = link(p, "frameName");
  const char* const xyz = p.has("xyzOffsets") ? "xyzOffsets" : "xyzOffset";
  const char* const rpy = p.has("rpyOffsets") ? "rpyOffsets" : "rpyOffset";
  const auto at = p.numbers(xyz, {0, 0, 0}), turned = p.numbers(rpy, {0, 0, 0});
  offset_ = kiva::Pose(at[0], at[1], at[2], turned[0], turned[1], turned[2]);
  noise_ = p.number("gaussianNoise", 0, 0, 1e6);
  schedule_ = Schedule(p.number("updateRate", 0, 0, 1e6));
  message_.header.frame_id = frame(frame_name);
  message_.child_frame_id = link_;
  for (int i = 0; i < 36; i += 7) {
    message_.pose.covariance[i] = message_.twist.covariance[i] = noise_ * noise_;
  }
  skip(p, {"alwaysOn"});
  publisher_ = advertise<nav_msgs::Odometry>(required(p, "topicName"));
}

void P3d::afterStep(const kiva::World& world, double) {
  if (!schedule_.isDue(world.time()) || publisher_.getNumSubscribers() == 0) return;
  const auto state = world.state(model(), link_);
  if (!state) return;
  kiva::Pose pose = state->pose;
  kiva::Twist twist = state->twist;
  if (!reference_.empty()) {
    const auto seen_from = world.state(model(), reference_);
    if (!seen_from) return;
    const kiva::Quaternion& turned = seen_from->pose.Rot();
    pose = seen_from->pose.Inverse() * pose;
    twist.linear = turned.RotateVectorReverse(twist.linear - seen_from->twist.linear);
    twist.angular = turned.RotateVectorReverse(twist.angular - seen_from->twist.angular);
  }
  pose = kiva::Pose(pose.Pos() + offset_.Pos(), (offset_.Rot() * pose.Rot()).Normalized());
  nav_msgs::Odometry out = message_;
  const std::string frame_id = message_.header.frame_id;
  out.header = header(world.time(), frame_id);
  out.pose.pose = toMessage(pose);
  out.twist.twist = toMessage(
      kiva::Twist{noisy(world, twist.linear, noise_, 0), noisy(world, twist.angular, noise_, 3)});
  publish(publisher_, std::move(out));
}

}  // namespace kiva_ros
