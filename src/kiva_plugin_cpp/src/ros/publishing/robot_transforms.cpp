// SPDX-License-Identifier: Apache-2.0
#include "robot_transforms.h"

#include <string>

#include "ros/messages/convert.h"

namespace kiva_ros {
namespace {

constexpr int kQueue = 100;

kiva::Pose laserPose(const kiva::LaserParameters& laser) { return {laser.x, 0, laser.z, 0, 0, 0}; }

/// Returns a wheel's pose turned about its axle, which lies along y.
kiva::Pose turned(const kiva::Pose& wheel, double angle) {
  return {wheel.Pos(), kiva::Quaternion(0, angle, 0) * wheel.Rot()};
}

kiva::Pose raised(const kiva::Pose& tower, double height) {
  return {tower.Pos() + kiva::Vector3(0, 0, height), tower.Rot()};
}

}  // namespace

RobotTransforms::RobotTransforms(ros::NodeHandle& node, SubscriberCounts& subscribers,
                                 bool locates_steered)
    : locates_steered_(locates_steered),
      moving_(advertiseCounted<tf2_msgs::TFMessage>(
          node, "tf", kQueue,
          [&subscribers](int change) {
            subscribers.count(SubscriberCounts::Topic::kTransforms, change);
          })),
      fixed_(node.advertise<tf2_msgs::TFMessage>("tf_static", kQueue, true)) {
  update({});
}

void RobotTransforms::update(const RobotInfos& robots) {
  robots_.clear();
  tf2_msgs::TFMessage out;
  out.transforms.push_back(transform(0, "world", "map", kiva::Pose::Zero));
  for (const RobotInfo& robot : robots) {
    robots_[robot.id] = robot;
    if (!robot.laser.fitted) continue;
    const std::string name = "kiva" + std::to_string(robot.id);
    out.transforms.push_back(
        transform(0, name + "/base_link", name + "/laser", laserPose(robot.laser)));
  }
  fixed_.publish(out);
}

/// Adds the odometry of a steered robot, and the place of that in the map, as a perfect
/// localisation would know it.
void RobotTransforms::addSteered(const RobotPose& robot, const std::string& name, double time,
                                 tf2_msgs::TFMessage* out) const {
  const std::string odometry = name + "/odom";
  if (locates_steered_) {
    out->transforms.push_back(
        transform(time, "map", odometry, robot.base * robot.counted->Inverse()));
  }
  out->transforms.push_back(transform(time, odometry, name + "/base_link", *robot.counted));
}

void RobotTransforms::publish(const std::vector<RobotPose>& robots, double time) {
  tf2_msgs::TFMessage out;
  for (const RobotPose& robot : robots) {
    const auto at = robots_.find(robot.kiva_id);
    if (at == robots_.end()) continue;
    const RobotInfo& fixed = at->second;
    const std::string name = "kiva" + std::to_string(robot.kiva_id);
    const std::string base = name + "/base_link";
    if (robot.counted) {
      addSteered(robot, name, time, &out);
    } else {
      out.transforms.push_back(transform(time, "world", base, robot.base));
    }
    out.transforms.push_back(transform(time, base, name + "/left_wheel",
                                       turned(fixed.left_wheel, robot.wheel_angle[0])));
    out.transforms.push_back(transform(time, base, name + "/right_wheel",
                                       turned(fixed.right_wheel, robot.wheel_angle[1])));
    out.transforms.push_back(
        transform(time, base, name + "/tower", raised(fixed.tower, robot.tower)));
  }
  if (!out.transforms.empty()) moving_.publish(out);
}

}  // namespace kiva_ros
