// SPDX-License-Identifier: Apache-2.0
//
// The reference frames of Gazebo's services: empty, world, map and /map are inertial, otherwise a
// model or `model::link`.
#pragma once

#include <optional>
#include <string>
#include <utility>

#include "kiva_plugin_cpp/world.h"

namespace kiva_ros {

/// Returns the two names in `model::link`, or a model's name alone.
std::pair<std::string, std::string> splitScoped(const std::string& name);

/// Returns the model and the name in it of a joint, given as `model::joint` or by its name alone,
/// of the first model with such a joint. Returns nothing if there is none.
std::optional<std::pair<std::string, std::string>> findJoint(const kiva::World& world,
                                                             const std::string& name);

/// Returns whether a frame is the world's own.
bool isInertial(const std::string& frame);

/// Returns the state of a frame in world; nothing if there is no such frame.
std::optional<kiva::EntityState> frameState(const kiva::World& world, const std::string& frame);

/// Convert a state in world to a frame, and back. As in Gazebo, a frame's own velocity counts only
/// in relativeTo, and its rotation adds no velocity at a distance.
kiva::EntityState relativeTo(const kiva::EntityState& frame, const kiva::EntityState& in_world);
kiva::EntityState inWorld(const kiva::EntityState& frame, const kiva::EntityState& in_frame);

}  // namespace kiva_ros
