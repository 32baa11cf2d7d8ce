// SPDX-License-Identifier: Apache-2.0
#include "ros/gazebo_plugins/drives/force.h"

#include "ros/gazebo_plugins/base/saved_numbers.h"

namespace kiva_ros {
namespace {

constexpr double kMost = 1e9;  // [N, Nm]

kiva::Vector3 boundedVector(double x, double y, double z) {
  return {bounded(x, kMost), bounded(y, kMost), bounded(z, kMost)};
}

}  // namespace

void Force::load(kiva::World& world, const std::string& model, const kiva::Parameters& p) {
  enter(world, model, p, "", "");
  if (description().is_static) throw kiva::DescriptionError("'" + model + "' is static");
  link_ = link(p, "bodyName");
  skip(p, {"alwaysOn", "updateRate"});
  wrenches_ = subscribe<geometry_msgs::Wrench>(required(p, "topicName"));
}

void Force::beforeStep(kiva::World& world, double) {
  if (const geometry_msgs::Wrench* wrench = wrenches_.take()) {
    force_ = boundedVector(wrench->force.x, wrench->force.y, wrench->force.z);
    torque_ = boundedVector(wrench->torque.x, wrench->torque.y, wrench->torque.z);
  }
  constexpr double kNothing = 1e-3;  // [N, Nm]
  if (force_.Equal(kiva::Vector3::Zero, kNothing) && torque_.Equal(kiva::Vector3::Zero, kNothing))
    return;
  world.applyWrench(model(), link_, force_, torque_);
}

void Force::reset(kiva::World&) { force_ = torque_ = kiva::Vector3::Zero; }

std::string Force::save() const {
  return toText({force_.X(), force_.Y(), force_.Z(), torque_.X(), torque_.Y(), torque_.Z()});
}

void Force::restore(kiva::World&, const std::string& state) {
  const std::vector<double> v = fromText(state, 6);
  force_ = boundedVector(v[0], v[1], v[2]);
  torque_ = boundedVector(v[3], v[4], v[5]);
}

}  // namespace kiva_ros
