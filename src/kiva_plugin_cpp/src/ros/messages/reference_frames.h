// SPDX-License-Identifier: Apache-2.0
//
// The entities and reference frames that Gazebo's services name: `model::link`, or the name of a
// model or link alone. The frames "", world, map and /map are inertial.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "kiva_plugin_cpp/world.h"

namespace kiva_ros {

/// A model's name, and that of a link or joint in it; the second is empty for the model itself.
using ScopedName = std::pair<std::string, std::string>;

/// Returns the two names in `model::link`, or a model's name alone.
ScopedName splitScoped(const std::string& name);

/// Returns the model or link that a name means, as Gazebo's World::EntityByName does: the one with
/// that scoped name, or the first with that name. Each model precedes its links, and models are in
/// the order of their addition. Returns nullopt for an unknown name.
std::optional<ScopedName> findEntity(const kiva::World& world, const std::string& name);

/// Returns the model of a joint and its name there. The joint is given as `model::joint`, or by its
/// name alone for the first model that has it. Returns nullopt for an unknown joint.
std::optional<ScopedName> findJoint(const kiva::World& world, const std::string& name);

/// Returns whether a frame is the world's own.
bool isInertial(const std::string& frame);

/// Returns the state of a frame in world; nothing if there is no such frame.
std::optional<kiva::EntityState> frameState(const kiva::World& world, const std::string& frame);

/// Convert a state in world to a frame, and back. As in Gazebo, a frame's own velocity counts only
/// in relativeTo, and its rotation adds no velocity at a distance.
kiva::EntityState relativeTo(const kiva::EntityState& frame, const kiva::EntityState& in_world);
kiva::EntityState inWorld(const kiva::EntityState& frame, const kiva::EntityState& in_frame);

}  // namespace kiva_ros
