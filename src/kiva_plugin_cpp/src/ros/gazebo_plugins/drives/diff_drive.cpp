// SPDX-License-Identifier: Apache-2.0
#include "ros/gazebo_plugins/drives/diff_drive.h"

#include <sensor_msgs/JointState.h>
#include <tf2_msgs/TFMessage.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "ros/gazebo_plugins/base/saved_numbers.h"
#include "ros/messages/convert.h"

namespace kiva_ros {

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
  skip(p, {"alwaysOn", "rosDebugLevel", "broadcastTF"});
  openTopics(world, p);
  if (publish_wheel_joints_) joints_ = advertise<sensor_msgs::JointState>("joint_states");
}

/// Decides which wheel is the left one by their positions. With <legacyMode> the sides are as they
/// are named; true swaps them, as in Gazebo.
void DiffDrive::readWheels(const kiva::World& world, const kiva::Parameters& p) {
  const char* const keys[] = {"leftJoint", "rightJoint"};
  const char* const names[] = {"left_joint", "right_joint"};
  double y[2];
  for (int side : {kLeft, kRight}) {
    std::string& name = wheels_[side].motor.joint;
    name = joint(world, p, keys[side], names[side]);
    y[side] = description().findJoint(name)->anchor_in_model.Y();
  }
  const bool is_swapped = p.has("legacyMode") ? p.flag("legacyMode", true) : y[kLeft] < y[kRight];
  turn_sign_ = is_swapped ? -1 : 1;
}

double DiffDrive::desiredSpeed(Side side) const {
  const double sign = turn_sign_ * (side == kLeft ? -1 : 1);
  return command().speed + sign * command().turn * separation_ / 2;
}

void DiffDrive::beforeStep(kiva::World& world, double dt) {
  takeCommand();
  const double most = acceleration_ > 0 ? acceleration_ * dt : std::numeric_limits<double>::max();
  for (Side side : {kLeft, kRight}) {
    Wheel& wheel = wheels_[side];
    wheel.target += std::clamp(desiredSpeed(side) - wheel.target, -most, most);
    wheel.motor.drive(world, model(), wheel.target / radius_, torque_);
  }
}

void DiffDrive::afterStep(const kiva::World& world, double dt) {
  if (by_encoder_) integrate(world, dt);
  if (!schedule_.isDue(world.time())) return;
  if (publish_odometry_) {
    const kiva::EntityState state = by_encoder_ ? encoder_ : trueOdometry(world);
    publishOdometry(world, state);
    if (publish_odometry_tf_) publishOdometryTransform(world, state);
  }
  if (publish_wheel_tf_ || publish_wheel_joints_) publishWheels(world);
}

void DiffDrive::reset(kiva::World&) {
  setCommand({});
  encoder_ = {};
  for (Wheel& wheel : wheels_) {
    wheel.target = 0;
    wheel.motor.applied = WheelMotor::kUnknown;
  }
}

std::string DiffDrive::save() const {
  const kiva::Pose& pose = encoder_.pose;
  return toText({command().speed, command().turn, wheels_[kLeft].target, wheels_[kRight].target,
                 pose.X(), pose.Y(), pose.Rot().Yaw(), wheels_[kLeft].motor.applied,
                 wheels_[kRight].motor.applied});
}

void DiffDrive::restore(kiva::World& world, const std::string& state) {
  reset(world);
  std::vector<double> values = fromText(state, 9);
  for (int i = 0; i < 7; ++i) values[i] = bounded(values[i], kMost);
  setCommand({values[0], 0, values[1]});
  wheels_[kLeft].target = values[2];
  wheels_[kRight].target = values[3];
  // The motors are restored already; setting them again would change the future of the world.
  wheels_[kLeft].motor.applied = values[7];
  wheels_[kRight].motor.applied = values[8];
  encoder_.pose = kiva::Pose(values[4], values[5], 0, 0, 0, values[6]);
}

/// Siegwart, Nourbakhsh & Scaramuzza, Introduction to Autonomous Mobile Robots (2011), 5.2.4.
void DiffDrive::integrate(const kiva::World& world, double dt) {
  double rim[2] = {0, 0};
  for (int side : {kLeft, kRight}) {
    if (const auto joint = world.joint(model(), wheels_[side].motor.joint)) {
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

void DiffDrive::publishWheels(const kiva::World& world) {
  sensor_msgs::JointState joints;
  tf2_msgs::TFMessage tf;
  joints.header = header(world.time(), "");
  for (const Wheel& wheel : wheels_) {
    const kiva::Joint& joint = *description().findJoint(wheel.motor.joint);
    const auto state = world.joint(model(), wheel.motor.joint);
    const auto parent = world.state(model(), joint.parent);
    const auto child = world.state(model(), joint.child);
    if (!state || !child) continue;
    joints.name.push_back(wheel.motor.joint);
    joints.position.push_back(state->position);
    joints.velocity.push_back(state->rate);
    const kiva::Pose base = parent ? parent->pose : kiva::Pose::Zero;
    tf.transforms.push_back(transform(world.time(), ownFrame(joint.parent), ownFrame(joint.child),
                                      base.Inverse() * child->pose));
  }
  if (publish_wheel_joints_) publish(joints_, joints);
  if (publish_wheel_tf_) publish(transforms(), tf);
}

}  // namespace kiva_ros
