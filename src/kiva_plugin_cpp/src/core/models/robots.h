// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/state/world_state.h"

namespace kiva {

/// Whether the description is a Kiva robot's: it names the motion plugin.
bool isRobot(const ModelDescription& description);

/// Takes its mass and its inertia about z through the model's origin from the links.
void weighRobot(const ModelDescription& description, Robot* robot);
/// Makes a robot of the model in that slot, by its plugins' parameters. Throws DescriptionError.
void addRobot(WorldState& world, int slot);
/// Takes it out of the fleet; what it carries is put down.
void removeRobot(WorldState& world, int robot);
/// Puts it there; a command it is at ends in BLOCKED.
void placeRobot(WorldState& world, int robot, const EntityState& state);
/// Back to where it was spawned: at rest, tower down, without load or command.
void resetRobot(WorldState& world, int robot);

/// Of one of its links, wheels turned and tower raised, in world.
Pose robotLinkPose(const WorldState& world, int robot, int link);

}  // namespace kiva
