// SPDX-License-Identifier: Apache-2.0
#include "ros/gazebo_plugins/sensors/ft_sensor.h"

#include <geometry_msgs/WrenchStamped.h>

#include "ros/messages/convert.h"

namespace kiva_ros {

void FtSensor::load(kiva::World& world, const std::string& model, const kiva::Parameters& p) {
  enter(world, model, p, "", "");
  joint_ = p.text("jointName", "");
  const kiva::Joint* joint = description().findJoint(joint_);
  if (!joint || !world.jointWrench(model, joint_)) {
    throw kiva::DescriptionError(
        "<jointName> is '" + joint_ + "', which is not a joint of '" + model +
        "' (a URDF's fixed joints are merged away unless they are preserved by "
        "<gazebo><preserveFixedJoint>)");
  }
  child_ = joint->child;
  noise_ = p.number("gaussianNoise", 0, 0, 1e6);
  schedule_ = Schedule(p.number("updateRate", 0, 0, 1e6));
  skip(p, {"alwaysOn"});
  publisher_ = advertise<geometry_msgs::WrenchStamped>(required(p, "topicName"));
}

void FtSensor::afterStep(const kiva::World& world, double) {
  if (!schedule_.isDue(world.time()) || publisher_.getNumSubscribers() == 0) return;
  const auto wrench = world.jointWrench(model(), joint_);
  const auto child = world.state(model(), child_);
  if (!wrench || !child) return;
  // The joint's wrench on its child is the negative of the child's on the joint.
  const kiva::Quaternion& turned = child->pose.Rot();
  const kiva::Vector3 force = turned.RotateVectorReverse(-wrench->force);
  const kiva::Vector3 torque = turned.RotateVectorReverse(-wrench->torque);
  geometry_msgs::WrenchStamped out;
  out.header = header(world.time(), child_);
  out.wrench.force = toMessage(noisy(world, force, noise_, 0));
  out.wrench.torque = toMessage(noisy(world, torque, noise_, 3));
  publish(publisher_, std::move(out));
}

}  // namespace kiva_ros
