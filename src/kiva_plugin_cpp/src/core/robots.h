// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parts.h"

namespace kiva {

/// Whether the description is a Kiva robot's: it names the motion plugin.
bool isRobot(const ModelDescription& description);

/// Takes its mass and its inertia about z through the model's origin from the links.
void weighRobot(const ModelDescription& description, Robot* robot);
/// Makes a robot of the model in that slot, by its plugins' parameters. Throws DescriptionError.
void addRobot(Parts& parts, int slot);
/// Takes it out of the fleet; what it carries is put down.
void removeRobot(Parts& parts, int robot);
/// Puts it there; a command it is at ends in BLOCKED.
void placeRobot(Parts& parts, int robot, const EntityState& state);
/// Back to where it was spawned: at rest, tower down, without load or command.
void resetRobot(Parts& parts, int robot);

/// Of one of its links, wheels turned and tower raised, in world.
Pose robotLinkPose(const Parts& parts, int robot, int link);

}  // namespace kiva
