// SPDX-License-Identifier: Apache-2.0
//
// Converts the state of robots and warehouse, and events, to messages.
#pragma once

#include <nav_msgs/Odometry.h>
#include <sensor_msgs/LaserScan.h>
#include <warehouse_msgs/Collision.h>
#include <warehouse_msgs/Event.h>
#include <warehouse_msgs/FleetState.h>
#include <warehouse_msgs/KivaStatus.h>
#include <warehouse_msgs/People.h>
#include <warehouse_msgs/UnitStates.h>
#include <warehouse_msgs/WarehouseObjects.h>

#include "kiva_plugin_cpp/world.h"
#include "snapshot.h"

namespace kiva_ros {

warehouse_msgs::Event toMessage(const kiva::Event& event);
/// Returns the message of a collision's event.
warehouse_msgs::Collision toCollision(const kiva::Event& event);
warehouse_msgs::KivaStatus toMessage(const kiva::StatusChange& status);
sensor_msgs::LaserScan toMessage(const Scan& scan, const kiva::LaserParameters& laser, double time);
nav_msgs::Odometry toMessage(const RobotPose& robot, double time);

/// Returns a robot's present status.
kiva::StatusChange statusOf(const kiva::World& world, int robot);
warehouse_msgs::FleetState fleetState(const kiva::World& world);
/// Returns the people on the floor and the robots that slow down for them; empty without people.
warehouse_msgs::People peopleMessage(const kiva::World& world);
warehouse_msgs::WarehouseObjects warehouseObjects(const kiva::World& world);
warehouse_msgs::UnitStates unitStates(const kiva::World& world);

}  // namespace kiva_ros
