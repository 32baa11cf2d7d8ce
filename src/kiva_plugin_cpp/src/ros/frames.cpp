// SPDX-License-Identifier: Apache-2.0
#include "frames.h"

namespace kiva_ros {

std::pair<std::string, std::string> splitScoped(const std::string& name) {
  const std::size_t at = name.find("::");
  if (at == std::string::npos) return {name, ""};
  return {name.substr(0, at), name.substr(at + 2)};
}

std::optional<kiva::EntityState> frameState(const kiva::World& world, const std::string& frame) {
  for (const char* inertial : {"", "world", "map", "/map"}) {
    if (frame == inertial) return kiva::EntityState{};
  }
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
