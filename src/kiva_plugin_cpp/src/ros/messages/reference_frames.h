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

/// `model::link`, or a model alone, as its two names.
std::pair<std::string, std::string> splitScoped(const std::string& name);

/// The model and the name in it of a joint: `model::joint`, or the first model's that has one of
/// that name. Nothing if there is none.
std::optional<std::pair<std::string, std::string>> findJoint(const kiva::World& world,
                                                             const std::string& name);

/// Whether that is a name of the world's own frame.
bool isInertial(const std::string& frame);

/// The state of a frame in world; nothing if there is no such frame.
std::optional<kiva::EntityState> frameState(const kiva::World& world, const std::string& frame);

/// A state in world as it is seen from a frame, and back. As in Gazebo, a frame's own velocity
/// counts only on the way into it, and its rotation adds no velocity at a distance.
kiva::EntityState relativeTo(const kiva::EntityState& frame, const kiva::EntityState& in_world);
kiva::EntityState inWorld(const kiva::EntityState& frame, const kiva::EntityState& in_frame);

}  // namespace kiva_ros
