// SPDX-License-Identifier: Apache-2.0
#include "ros/gazebo_plugins/sensors/joint_states.h"

#include <sensor_msgs/JointState.h>

#include <algorithm>
#include <sstream>

#include "ros/messages/convert.h"

namespace kiva_ros {
namespace {

/// Returns the parts of `a, b,c`.
std::vector<std::string> listOf(std::string text) {
  std::replace(text.begin(), text.end(), ',', ' ');
  std::istringstream words(text);
  std::vector<std::string> out;
  for (std::string word; words >> word;) out.push_back(word);
  return out;
}

}  // namespace

void JointStates::load(kiva::World& world, const std::string& model, const kiva::Parameters& p) {
  enter(world, model, p, model, model);
  joints_ = listOf(p.text("jointName", ""));
  for (const std::string& joint : joints_) {
    if (description().findJoint(joint)) continue;
    throw kiva::DescriptionError("<jointName>: '" + joint + "' is not a joint of '" + model + "'");
  }
  if (joints_.empty()) {
    for (const kiva::Joint& joint : description().joints) {
      if (joint.hasAxis()) joints_.push_back(joint.name);
    }
  }
  schedule_ = Schedule(p.number("updateRate", 100, 0, 1e6));
  skip(p, {"alwaysOn"});
  publisher_ = advertise<sensor_msgs::JointState>("joint_states");
}

void JointStates::afterStep(const kiva::World& world, double) {
  if (!schedule_.isDue(world.time()) || publisher_.getNumSubscribers() == 0) return;
  sensor_msgs::JointState out;
  out.header = header(world.time(), "");
  for (const std::string& name : joints_) {
    const auto joint = world.joint(model(), name);
    if (!joint) continue;
    out.name.push_back(name);
    out.position.push_back(joint->position);
    out.velocity.push_back(joint->rate);
  }
  publish(publisher_, std::move(out));
}

}  // namespace kiva_ros
