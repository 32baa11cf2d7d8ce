// SPDX-License-Identifier: Apache-2.0
#include "reference_frames.h"

namespace kiva_ros {

std::pair<std::string, std::string> splitScoped(const std::string& name) {
  const std::size_t at = name.find("::");
  if (at == std::string::npos) return {name, ""};
  return {name.substr(0, at), name.substr(at + 2)};
}

std::optional<std::pair<std::string, std::string>> findJoint(const kiva::World& world,
                                                             const std::string& name) {
  const auto has = [&world](const std::string& model, const std::string& joint) {
    const auto description = world.description(model);
    return description && description->findJoint(joint);
  };
  const auto scoped = splitScoped(name);
  if (has(scoped.first, scoped.second)) return scoped;
  for (const std::string& model : world.modelNames()) {
    if (has(model, name)) return std::make_pair(model, name);
  }
  return std::nullopt;
}

bool isInertial(const std::string& frame) {
  return frame.empty() || frame == "world" || frame == "map" || frame == "/map";
}

std::optional<kiva::EntityState> frameState(const kiva::World& world, const std::string& frame) {
  if (isInertial(frame)) return kiva::EntityState{};
  const auto [model, link] = splitScoped(frame);
  return world.state(model, link);
}

kiva::EntityState relativeTo(const kiva::EntityState& frame, const kiva::EntityState& in_world) {
  const kiva::Quaternion& rotation = frame.pose.Rot();
  return {frame.pose.Inverse() * in_world.pose,
          {rotation.RotateVectorReverse(in_world.twist.linear - frame.twist.linear),
           rotation.RotateVectorReverse(in_world.twist.angular - frame.twist.angular)}};
}

kiva::EntityState inWorld(const kiva::EntityState& frame, const kiva::EntityState& in_frame) {
  const kiva::Quaternion& rotation = frame.pose.Rot();
  return {frame.pose * in_frame.pose,
          {rotation.RotateVector(in_frame.twist.linear),
           rotation.RotateVector(in_frame.twist.angular)}};
}

}  // namespace kiva_ros
