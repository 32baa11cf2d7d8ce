// SPDX-License-Identifier: Apache-2.0
//
// What only a picture of the warehouse needs, as messages.
#pragma once

#include <warehouse_msgs/FleetPaths.h>
#include <warehouse_msgs/Scenery.h>

#include "kiva_plugin_cpp/world.h"

namespace kiva_ros {

warehouse_msgs::Scenery sceneryOf(const kiva::World& world);
/// Brings its poses and its time up to date while no model comes or goes. Whether any moved.
bool updatePoses(const kiva::World& world, warehouse_msgs::Scenery* scenery);
warehouse_msgs::FleetPaths pathsOf(const kiva::World& world);

}  // namespace kiva_ros
