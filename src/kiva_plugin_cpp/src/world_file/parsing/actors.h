// SPDX-License-Identifier: Apache-2.0
//
// An `<actor>` of Gazebo: a person that walks by a script. Here all people look alike.
#pragma once

#include "kiva_plugin_cpp/people.h"
#include "world_file/files/xml.h"

namespace kiva {

/// Returns the position of an actor's first waypoint, or else of its pose, on the ground: an
/// actor's origin is somewhere in its skin.
Pose placeOf(const XmlElement& actor);

/// Returns the walk by an actor's waypoints and their times; without a script the actor stays.
/// Leaves out waypoints that make no sense, each with a warning.
Walk scriptOf(const XmlElement& actor, Faults* warnings);

}  // namespace kiva
