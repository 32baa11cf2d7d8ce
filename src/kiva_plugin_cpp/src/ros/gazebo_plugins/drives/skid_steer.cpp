// SPDX-License-Identifier: Apache-2.0
#include "ros/gazebo_plugins/drives/skid_steer.h"

#include "ros/gazebo_plugins/base/saved_numbers.h"

namespace kiva_ros {

void SkidSteer::load(kiva::World& world, const std::string& model, const kiva::Parameters& p) {
  enter(world, model, p, "", "");
  const char* const keys[][2] = {{"leftFrontJoint", "left_front_joint"},
                                 {"rightFrontJoint", "right_front_joint"},
                                 {"leftRearJoint", "left_rear_joint"},
                                 {"rightRearJoint", "right_rear_joint"}};
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    wheels_[i].joint = joint(world, p, keys[i][0], keys[i][1]);
  }
  separation_ = p.number("wheelSeparation", 0.4, 1e-6, kMost);
  radius_ = p.number("wheelDiameter", 0.15, 1e-6, kMost) / 2;
  torque_ = p.number("torque", 5, 0, kMost);
  schedule_ = Schedule(p.number("updateRate", 100, 0, kMost));
  publish_transform_ = p.flag("broadcastTF", false);
  setCovariance({p.number("covariance_x", 1e-4, 0, 1e12), p.number("covariance_y", 1e-4, 0, 1e12),
                 p.number("covariance_yaw", 0.01, 0, 1e12)});
  skip(p, {"alwaysOn"});
  openTopics(world, p);
}

void SkidSteer::beforeStep(kiva::World& world, double) {
  takeCommand();
  const double half = command().turn * separation_ / 2;
  for (std::size_t i = 0; i < wheels_.size(); ++i) {
    const double rim = command().speed + (i % 2 == 0 ? -half : half);
    wheels_[i].drive(world, model(), rim / radius_, torque_);
  }
}

void SkidSteer::afterStep(const kiva::World& world, double) {
  if (!schedule_.isDue(world.time())) return;
  const kiva::EntityState state = trueOdometry(world);
  publishOdometry(world, state);
  if (publish_transform_) publishOdometryTransform(world, state);
}

void SkidSteer::reset(kiva::World&) {
  setCommand({});
  for (WheelMotor& wheel : wheels_) wheel.applied = WheelMotor::kUnknown;
}

std::string SkidSteer::save() const {
  std::vector<double> numbers{command().speed, command().turn};
  for (const WheelMotor& wheel : wheels_) numbers.push_back(wheel.applied);
  return toText(numbers);
}

void SkidSteer::restore(kiva::World&, const std::string& state) {
  const std::vector<double> numbers = fromText(state, 2 + wheels_.size());
  setCommand({bounded(numbers[0], kMost), 0, bounded(numbers[1], kMost)});
  // The motors are restored already; setting them again would change the future of the world.
  for (std::size_t i = 0; i < wheels_.size(); ++i) wheels_[i].applied = numbers[2 + i];
}

}  // namespace kiva_ros
