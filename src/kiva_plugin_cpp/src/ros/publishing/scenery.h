// SPDX-License-Identifier: Apache-2.0
//
// Makes the messages that only viewers of the warehouse need.
#pragma once

#include <warehouse_msgs/FleetPaths.h>
#include <warehouse_msgs/Scenery.h>

#include "kiva_plugin_cpp/world.h"

namespace kiva_ros {

warehouse_msgs::Scenery sceneryOf(const kiva::World& world);
/// Updates the poses and the time of a scenery while no model is added or removed. Returns whether
/// any model moved.
bool updatePoses(const kiva::World& world, warehouse_msgs::Scenery* scenery);
warehouse_msgs::FleetPaths pathsOf(const kiva::World& world);

}  // namespace kiva_ros
