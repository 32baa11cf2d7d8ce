// SPDX-License-Identifier: Apache-2.0
//
// The command topics and their messages.
#pragma once

#include <warehouse_msgs/Cancel.h>
#include <warehouse_msgs/FleetFollow.h>
#include <warehouse_msgs/FleetOrders.h>
#include <warehouse_msgs/FollowPath.h>
#include <warehouse_msgs/Lift.h>
#include <warehouse_msgs/LimitedPath.h>
#include <warehouse_msgs/MoveAlong.h>
#include <warehouse_msgs/MoveTo.h>
#include <warehouse_msgs/Rotate.h>
#include <warehouse_msgs/Stop.h>

#include "order.h"

namespace kiva_ros {

kiva::Command fromMessage(const warehouse_msgs::MoveTo& message);
kiva::Command fromMessage(const warehouse_msgs::MoveAlong& message, kiva::Command::Kind axis);
kiva::Command fromMessage(const warehouse_msgs::Rotate& message);
kiva::Command fromMessage(const warehouse_msgs::Lift& message);
kiva::Command fromMessage(const warehouse_msgs::Cancel& message);
kiva::Command fromMessage(const warehouse_msgs::Stop& message);
kiva::FollowPath fromMessage(const warehouse_msgs::FollowPath& message);
kiva::FollowPath fromMessage(const warehouse_msgs::LimitedPath& message);
/// Returns an order for every robot; if the arrays disagree, a single order that states this fault.
Orders fromMessage(const warehouse_msgs::FleetFollow& message);
/// Returns cancellations first, then paths, then lifts.
Orders fromMessage(const warehouse_msgs::FleetOrders& message);

warehouse_msgs::MoveTo toMoveTo(const kiva::Command& command);
warehouse_msgs::MoveAlong toMoveAlong(const kiva::Command& command);
warehouse_msgs::Rotate toRotate(const kiva::Command& command);
warehouse_msgs::Lift toLift(const kiva::Command& command);
warehouse_msgs::Cancel toCancel(const kiva::Command& command);
warehouse_msgs::Stop toStop(const kiva::Command& command);
warehouse_msgs::FollowPath toMessage(const kiva::FollowPath& path);
warehouse_msgs::LimitedPath toLimitedPath(const kiva::FollowPath& path);

/// Passes a type as a value.
template <typename T>
struct MessageType {
  using Message = T;
};

/// Calls `visit(MessageType<Message>(), topic, toOrders)` for each of the topics, where
/// toOrders(message) returns Orders. Topics are named relative to the world's namespace.
template <typename Visit>
void forEachCommandTopic(Visit visit) {
  using Kind = kiva::Command::Kind;
  using warehouse_msgs::MoveAlong;
  const auto as_is = [](const auto& message) { return Orders{fromMessage(message)}; };
  const auto along_x = [](const MoveAlong& m) { return Orders{fromMessage(m, Kind::kMoveX)}; };
  const auto along_y = [](const MoveAlong& m) { return Orders{fromMessage(m, Kind::kMoveY)}; };
  const auto each = [](const warehouse_msgs::FleetFollow& m) { return fromMessage(m); };
  visit(MessageType<warehouse_msgs::MoveTo>(), "mov", as_is);
  visit(MessageType<MoveAlong>(), "movx", along_x);
  visit(MessageType<MoveAlong>(), "movy", along_y);
  visit(MessageType<warehouse_msgs::Rotate>(), "rot", as_is);
  visit(MessageType<warehouse_msgs::Lift>(), "lift", as_is);
  visit(MessageType<warehouse_msgs::FollowPath>(), "follow", as_is);
  visit(MessageType<warehouse_msgs::LimitedPath>(), "follow_limited", as_is);
  visit(MessageType<warehouse_msgs::FleetFollow>(), "warehouse/follow", each);
  visit(MessageType<warehouse_msgs::Cancel>(), "cancel", as_is);
  visit(MessageType<warehouse_msgs::Stop>(), "stop", as_is);
}

}  // namespace kiva_ros
