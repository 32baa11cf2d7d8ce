// SPDX-License-Identifier: Apache-2.0
#include "ros/gazebo_plugins/drives/planar_move.h"

#include "ros/gazebo_plugins/base/saved_numbers.h"

namespace kiva_ros {

void PlanarMove::load(kiva::World& world, const std::string& model, const kiva::Parameters& p) {
  enter(world, model, p, "", "");
  if (description().is_static || world.kind(model) != kiva::ModelKind::kOther) {
    throw kiva::DescriptionError("'" + model + "' is not a model that can be given a velocity");
  }
  timeout_ = p.number("cmdTimeout", -1, -kMost, kMost);
  schedule_ = Schedule(p.number("odometryRate", 20, 0, kMost));
  skip(p, {"alwaysOn", "updateRate"});
  openTopics(world, p);
}

/// Collisions do not change the commanded velocity, as in Gazebo. Unlike there, the model falls,
/// and its wheels keep rolling.
void PlanarMove::beforeStep(kiva::World& world, double) {
  if (takeCommand()) commanded_ = world.time();
  if (timeout_ >= 0 && world.time() - commanded_ > timeout_) setCommand({});
  const kiva::EntityState now = *world.state(model());
  const kiva::Quaternion heading(0, 0, now.pose.Rot().Yaw());
  kiva::Vector3 linear = heading * kiva::Vector3(command().speed, command().aside, 0);
  linear.Z() = now.twist.linear.Z();
  world.setVelocity(model(), {linear, {0, 0, command().turn}});
}

void PlanarMove::afterStep(const kiva::World& world, double) {
  if (!schedule_.isDue(world.time())) return;
  const kiva::EntityState state = trueOdometry(world);
  publishOdometry(world, state);
  publishOdometryTransform(world, state);
}

void PlanarMove::reset(kiva::World&) {
  setCommand({});
  commanded_ = 0;
}

std::string PlanarMove::save() const {
  return toText({command().speed, command().aside, command().turn, commanded_});
}

void PlanarMove::restore(kiva::World&, const std::string& state) {
  const std::vector<double> numbers = fromText(state, 4);
  setCommand({bounded(numbers[0], kMost), bounded(numbers[1], kMost), bounded(numbers[2], kMost)});
  commanded_ = bounded(numbers[3], 1e12);
}

}  // namespace kiva_ros
