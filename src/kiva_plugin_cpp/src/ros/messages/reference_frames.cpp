// SPDX-License-Identifier: Apache-2.0
#include "reference_frames.h"

#include <cstdint>
#include <memory>
#include <unordered_map>
#include <unordered_set>

namespace kiva_ros {

ScopedName splitScoped(const std::string& name) {
  const std::size_t at = name.find("::");
  if (at == std::string::npos) return {name, ""};
  return {name.substr(0, at), name.substr(at + 2)};
}

namespace {

/// An index of links by plain names. It is rebuilt once a change of the models, since that takes
/// milliseconds in a large warehouse.
class PlainLinks {
 public:
  /// Returns the link that a name means, or nullptr where it means a model or nothing.
  const ScopedName* find(const kiva::World& world, const std::string& name) {
    if (world_ != &world || revision_ != world.modelsRevision()) read(world);
    const auto at = first_.find(name);
    return at == first_.end() ? nullptr : &at->second;
  }

 private:
  void read(const kiva::World& world) {
    world_ = &world;
    revision_ = world.modelsRevision();
    first_.clear();
    std::unordered_set<std::string> models;  // those before the present one
    std::shared_ptr<const kiva::ModelDescription>
        last_description;  // instances of one file mostly are consecutive
    for (const std::string& model : world.modelNames()) {
      models.insert(model);
      const auto description = world.description(model);
      if (description == last_description) continue;
      last_description = description;
      for (const kiva::Link& link : description->links) {
        const std::string name = withoutScope(link.name);
        if (!models.count(name)) first_.emplace(name, ScopedName(model, link.name));
      }
    }
  }

  /// Returns the name of a link without the names of the nested models around it.
  static std::string withoutScope(const std::string& link) {
    const std::size_t at = link.rfind("::");
    return at == std::string::npos ? link : link.substr(at + 2);
  }

  const kiva::World* world_ = nullptr;
  std::uint64_t revision_ = 0;
  std::unordered_map<std::string, ScopedName> first_;
};

}  // namespace

std::optional<ScopedName> findEntity(const kiva::World& world, const std::string& name) {
  const ScopedName scoped = splitScoped(name);
  if (!scoped.second.empty()) {
    const auto model = world.description(scoped.first);
    if (model && model->findLink(scoped.second)) return scoped;
    return std::nullopt;
  }
  static thread_local PlainLinks links;
  if (const ScopedName* link = links.find(world, name)) return *link;
  if (world.has(name)) return scoped;
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
