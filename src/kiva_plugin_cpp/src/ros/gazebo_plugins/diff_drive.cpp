// SPDX-License-Identifier: Apache-2.0
#include "diff_drive.h"

#include <nav_msgs/Odometry.h>
#include <sensor_msgs/JointState.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <sstream>

#include "ros/messages/convert.h"

namespace kiva_ros {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kMost = 1e6;  // of speeds and lengths, in SI units

/// What Gazebo's plugin claims to know of itself.
void setCovariance(nav_msgs::Odometry* odometry) {
  constexpr double kKnown = 1e-5, kUnknown = 1e12, kYaw = 1e-3;
  const double diagonal[] = {kKnown, kKnown, kUnknown, kUnknown, kUnknown, kYaw};
  for (int i = 0; i < 6; ++i) odometry->pose.covariance[7 * i] = diagonal[i];
}

}  // namespace

void DiffDrive::load(kiva::World& world, const std::string& model, const kiva::Parameters& p) {
  enter(world, model, p, model, model);
  readWheels(world, p);
  separation_ = p.number("wheelSeparation", 0.34, 1e-6, kMost);
  radius_ = p.number("wheelDiameter", 0.15, 1e-6, kMost) / 2;
  acceleration_ = p.number("wheelAcceleration", 0, 0, kMost);
  torque_ = p.number("wheelTorque", 5, 0, kMost);
  schedule_ = Schedule(p.number("updateRate", 100, 0, kMost));
  const std::string source = p.text("odometrySource", "world");
  by_encoder_ = source == "encoder" || source == "0";
  publish_odometry_ = p.flag("publishTf", true);
  publish_odometry_tf_ = p.flag("publishOdomTF", true);
  publish_wheel_tf_ = p.flag("publishWheelTF", false);
  publish_wheel_joints_ = p.flag("publishWheelJointState", false);
  odometry_frame_ = frame(p.text("odometryFrame", "odom"));
  base_frame_ = frame(p.text("robotBaseFrame", "base_footprint"));
  skip(p, {"alwaysOn", "rosDebugLevel", "broadcastTF"});
  const std::string topic = p.text("odometryTopic", "odom");
  odometry_ = node().advertise<nav_msgs::Odometry>(topic, 10);
  transforms_ = node().advertise<tf2_msgs::TFMessage>("/tf", 100);
  if (publish_wheel_joints_)
    joints_ = node().advertise<sensor_msgs::JointState>("joint_states", 10);
  commands_ = subscribe<geometry_msgs::Twist>(p.text("commandTopic", "cmd_vel"));
}

/// Which wheel is the left one is seen from where it sits. Where <legacyMode> says so the sides are
/// as they are called, in Gazebo's sense: swapped if it is true.
void DiffDrive::readWheels(const kiva::World& world, const kiva::Parameters& p) {
  const char* const keys[] = {"leftJoint", "rightJoint"};
  const char* const names[] = {"left_joint", "right_joint"};
  double y[2];
  for (int side : {kLeft, kRight}) {
    Wheel& wheel = wheels_[side];
    wheel.joint = p.text(keys[side], names[side]);
    wheel.applied = kNaN;
    const kiva::Joint* joint = description().findJoint(wheel.joint);
    if (!joint || !joint->hasAxis() || !world.joint(model(), wheel.joint)) {
      throw kiva::DescriptionError("<" + std::string(keys[side]) + "> is '" + wheel.joint +
                                   "', which is no joint of '" + model() + "' that moves");
    }
    y[side] = joint->anchor_in_model.Y();
  }
  const bool is_swapped = p.has("legacyMode") ? p.flag("legacyMode", true) : y[kLeft] < y[kRight];
  turn_sign_ = is_swapped ? -1 : 1;
}

void DiffDrive::onCommand(const geometry_msgs::Twist& command) {
  if (!std::isfinite(command.linear.x) || !std::isfinite(command.angular.z)) return;
  command_ = {std::clamp(command.linear.x, -kMost, kMost),
              std::clamp(command.angular.z, -kMost, kMost)};
}

double DiffDrive::wanted(Side side, const Command& command) const {
  const double sign = turn_sign_ * (side == kLeft ? -1 : 1);
  return command.speed + sign * command.turn * separation_ / 2;
}

void DiffDrive::beforeStep(kiva::World& world, double dt) {
  if (const geometry_msgs::Twist* command = commands_.take()) onCommand(*command);
  const double most = acceleration_ > 0 ? acceleration_ * dt : std::numeric_limits<double>::max();
  for (Side side : {kLeft, kRight}) {
    Wheel& wheel = wheels_[side];
    wheel.target += std::clamp(wanted(side, command_) - wheel.target, -most, most);
    const double speed = wheel.target / radius_;
    if (speed == wheel.applied) continue;
    const auto joint = world.joint(model(), wheel.joint);
    if (!joint) continue;
    kiva::JointSettings settings = joint->settings;
    settings.motor_speed = wheel.applied = speed;
    settings.motor_effort = torque_;
    world.setJoint(model(), wheel.joint, settings);
  }
}

void DiffDrive::afterStep(const kiva::World& world, double dt) {
  if (by_encoder_) integrate(world, dt);
  if (!schedule_.isDue(world.time())) return;
  if (publish_odometry_) publishOdometry(world);
  if (publish_wheel_tf_ || publish_wheel_joints_) publishWheels(world);
}

void DiffDrive::reset(kiva::World&) {
  command_ = {};
  encoder_ = {};
  for (Wheel& wheel : wheels_) {
    wheel.target = 0;
    wheel.applied = kNaN;
  }
}

std::string DiffDrive::save() const {
  const kiva::Pose& pose = encoder_.pose;
  std::ostringstream out;
  out << std::hexfloat << command_.speed << ' ' << command_.turn << ' ' << wheels_[kLeft].target
      << ' ' << wheels_[kRight].target << ' ' << pose.X() << ' ' << pose.Y() << ' '
      << pose.Rot().Yaw() << ' ' << wheels_[kLeft].applied << ' ' << wheels_[kRight].applied;
  return out.str();
}

void DiffDrive::restore(kiva::World& world, const std::string& state) {
  reset(world);
  std::istringstream words(state);
  double values[9] = {};
  for (double& value : values) {  // streams read no hexadecimal floats
    std::string word;
    words >> word;
    value = std::strtod(word.c_str(), nullptr);
  }
  // A checkpoint may come from anywhere.
  for (int i = 0; i < 7; ++i) {
    values[i] = std::isfinite(values[i]) ? std::clamp(values[i], -kMost, kMost) : 0;
  }
  command_ = {values[0], values[1]};
  wheels_[kLeft].target = values[2];
  wheels_[kRight].target = values[3];
  // The motors are as they were: to set them once more would be another future.
  wheels_[kLeft].applied = values[7];
  wheels_[kRight].applied = values[8];
  encoder_.pose = kiva::Pose(values[4], values[5], 0, 0, 0, values[6]);
}

/// Siegwart, Nourbakhsh & Scaramuzza, Introduction to Autonomous Mobile Robots (2011), 5.2.4.
void DiffDrive::integrate(const kiva::World& world, double dt) {
  double rim[2] = {0, 0};
  for (int side : {kLeft, kRight}) {
    if (const auto joint = world.joint(model(), wheels_[side].joint)) {
      rim[side] = joint->rate * radius_;
    }
  }
  const double speed = (rim[kLeft] + rim[kRight]) / 2;
  const double turn = turn_sign_ * (rim[kRight] - rim[kLeft]) / separation_;
  const double yaw = encoder_.pose.Rot().Yaw() + turn * dt / 2;
  encoder_.pose.Pos() += kiva::Vector3(std::cos(yaw), std::sin(yaw), 0) * speed * dt;
  encoder_.pose.Rot() = kiva::Quaternion(0, 0, yaw + turn * dt / 2);
  encoder_.twist = {{speed, 0, 0}, {0, 0, turn}};
}

kiva::EntityState DiffDrive::odometry(const kiva::World& world) const {
  if (by_encoder_) return encoder_;
  kiva::EntityState out = *world.state(model());
  const kiva::Quaternion heading(0, 0, out.pose.Rot().Yaw());
  const kiva::Vector3 seen = heading.RotateVectorReverse(out.twist.linear);
  out.twist = {{seen.X(), seen.Y(), 0}, {0, 0, out.twist.angular.Z()}};
  return out;
}

void DiffDrive::publishOdometry(const kiva::World& world) {
  const kiva::EntityState state = odometry(world);
  nav_msgs::Odometry out;
  out.header = header(world.time(), odometry_frame_);
  out.child_frame_id = base_frame_;
  out.pose.pose = toMessage(state.pose);
  out.twist.twist = toMessage(state.twist);
  setCovariance(&out);
  publish(odometry_, out);
  if (!publish_odometry_tf_) return;
  tf2_msgs::TFMessage tf;
  tf.transforms.push_back(transform(world.time(), odometry_frame_, base_frame_, state.pose));
  publish(transforms_, tf);
}

void DiffDrive::publishWheels(const kiva::World& world) {
  sensor_msgs::JointState joints;
  tf2_msgs::TFMessage tf;
  joints.header = header(world.time(), "");
  for (const Wheel& wheel : wheels_) {
    const kiva::Joint& joint = *description().findJoint(wheel.joint);
    const auto state = world.joint(model(), wheel.joint);
    const auto parent = world.state(model(), joint.parent);
    const auto child = world.state(model(), joint.child);
    if (!state || !child) continue;
    joints.name.push_back(wheel.joint);
    joints.position.push_back(state->position);
    joints.velocity.push_back(state->rate);
    const kiva::Pose base = parent ? parent->pose : kiva::Pose::Zero;
    tf.transforms.push_back(transform(world.time(), frame(joint.parent), frame(joint.child),
                                      base.Inverse() * child->pose));
  }
  if (publish_wheel_joints_) publish(joints_, joints);
  if (publish_wheel_tf_) publish(transforms_, tf);
}

}  // namespace kiva_ros
