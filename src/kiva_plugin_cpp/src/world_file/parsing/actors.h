// SPDX-License-Identifier: Apache-2.0
//
// An `<actor>` of Gazebo: a person that walks by a script. Here all people look alike.
#pragma once

#include "kiva_plugin_cpp/people.h"
#include "world_file/files/xml.h"

namespace kiva {

/// Where the first waypoint of an actor is, else its pose, on the ground: an actor's origin is
/// somewhere in its skin.
Pose placeOf(const XmlElement& actor);

/// How it walks, as its waypoints and their times tell; without a script it stays where it is.
/// Waypoints that make no sense are left out, and `warnings` is told so.
Walk scriptOf(const XmlElement& actor, Faults* warnings);

}  // namespace kiva
