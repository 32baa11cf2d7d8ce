// SPDX-License-Identifier: Apache-2.0
//
// The entities and reference frames that Gazebo's services name: `model::link`, or the name of a
// model or link alone. As frames empty, world, map and /map are inertial.
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

/// Returns the model or link that a name means, as Gazebo's World::EntityByName does: by its scoped
/// name, or the first called so, each model before its links, models in the order in which they
/// were added. Returns nullopt for an unknown name.
std::optional<ScopedName> findEntity(const kiva::World& world, const std::string& name);

/// Returns the model and the name in it of a joint, given as `model::joint` or by its name alone,
/// of the first model with such a joint. Returns nothing if there is none.
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
