// SPDX-License-Identifier: Apache-2.0
#include "reference_frames.h"

namespace kiva_ros {

ScopedName splitScoped(const std::string& name) {
  const std::size_t at = name.find("::");
  if (at == std::string::npos) return {name, ""};
  return {name.substr(0, at), name.substr(at + 2)};
}

namespace {

/// Returns the first link of a model whose name, without those of the models inside that it belongs
/// to, is this one. Returns nullptr if there is none.
const kiva::Link* linkCalled(const kiva::ModelDescription& model, const std::string& name) {
  for (const kiva::Link& link : model.links) {
    const std::size_t scope = link.name.rfind("::");
    const std::size_t begin = scope == std::string::npos ? 0 : scope + 2;
    if (link.name.compare(begin, std::string::npos, name) == 0) return &link;
  }
  return nullptr;
}

}  // namespace

std::optional<ScopedName> findEntity(const kiva::World& world, const std::string& name) {
  const ScopedName scoped = splitScoped(name);
  if (!scoped.second.empty()) {
    const auto model = world.description(scoped.first);
    if (model && model->findLink(scoped.second)) return scoped;
    return std::nullopt;
  }
  std::shared_ptr<const kiva::ModelDescription> seen;  // instances of one file stand in a row
  for (const std::string& model : world.modelNames()) {
    if (model == name) return ScopedName(model, "");
    const auto description = world.description(model);
    if (description == seen) continue;
    seen = description;
    if (const kiva::Link* link = linkCalled(*description, name)) {
      return ScopedName(model, link->name);
    }
  }
  return std::nullopt;
}

std::optional<ScopedName> findJoint(const kiva::World& world, const std::string& name) {
  const auto has = [&world](const std::string& model, const std::string& joint) {
    const auto description = world.description(model);
    return description && description->findJoint(joint);
  };
  const auto scoped = splitScoped(name);
  if (has(scoped.first, scoped.second)) return scoped;
  for (const std::string& model : world.modelNames()) {
    if (has(model, name)) return ScopedName(model, name);
  }
  return std::nullopt;
}

bool isInertial(const std::string& frame) {
  return frame.empty() || frame == "world" || frame == "map" || frame == "/map";
}

std::optional<kiva::EntityState> frameState(const kiva::World& world, const std::string& frame) {
  if (isInertial(frame)) return kiva::EntityState{};
  const auto entity = findEntity(world, frame);
  if (!entity) return std::nullopt;
  return world.state(entity->first, entity->second);
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
