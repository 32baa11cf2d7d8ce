// SPDX-License-Identifier: Apache-2.0
//
// The command topics, and what is said on them.
#pragma once

#include <warehouse_msgs/Lift.h>
#include <warehouse_msgs/MoveAlong.h>
#include <warehouse_msgs/MoveTo.h>
#include <warehouse_msgs/Rotate.h>

#include "kiva_plugin_cpp/world.h"

namespace kiva_ros {

kiva::Command fromMessage(const warehouse_msgs::MoveTo& message);
kiva::Command fromMessage(const warehouse_msgs::MoveAlong& message, kiva::Command::Kind axis);
kiva::Command fromMessage(const warehouse_msgs::Rotate& message);
kiva::Command fromMessage(const warehouse_msgs::Lift& message);

warehouse_msgs::MoveTo toMoveTo(const kiva::Command& command);
warehouse_msgs::MoveAlong toMoveAlong(const kiva::Command& command);
warehouse_msgs::Rotate toRotate(const kiva::Command& command);
warehouse_msgs::Lift toLift(const kiva::Command& command);

/// Names a type where a value is needed.
template <typename T>
struct MessageType {
  using Message = T;
};

/// Calls `visit(MessageType<Message>(), topic, toCommand)` for each of the topics, where
/// toCommand(message) is a kiva::Command.
template <typename Visit>
void forEachCommandTopic(Visit visit) {
  using Kind = kiva::Command::Kind;
  using warehouse_msgs::MoveAlong;
  const auto as_is = [](const auto& message) { return fromMessage(message); };
  const auto along_x = [](const MoveAlong& m) { return fromMessage(m, Kind::kMoveX); };
  const auto along_y = [](const MoveAlong& m) { return fromMessage(m, Kind::kMoveY); };
  visit(MessageType<warehouse_msgs::MoveTo>(), "/mov", as_is);
  visit(MessageType<MoveAlong>(), "/movx", along_x);
  visit(MessageType<MoveAlong>(), "/movy", along_y);
  visit(MessageType<warehouse_msgs::Rotate>(), "/rot", as_is);
  visit(MessageType<warehouse_msgs::Lift>(), "/lift", as_is);
}

}  // namespace kiva_ros
