// SPDX-License-Identifier: Apache-2.0
#include "command_messages.h"

namespace kiva_ros {

kiva::Command fromMessage(const warehouse_msgs::MoveTo& message) {
  kiva::Command out;
  out.kind = kiva::Command::Kind::kMoveTo;
  out.kiva_id = message.kiva_id;
  out.x = message.x;
  out.y = message.y;
  return out;
}

kiva::Command fromMessage(const warehouse_msgs::MoveAlong& message, kiva::Command::Kind axis) {
  kiva::Command out;
  out.kind = axis;
  out.kiva_id = message.kiva_id;
  (axis == kiva::Command::Kind::kMoveX ? out.x : out.y) = message.distance;
  return out;
}

kiva::Command fromMessage(const warehouse_msgs::Rotate& message) {
  kiva::Command out;
  out.kind = kiva::Command::Kind::kRotate;
  out.kiva_id = message.kiva_id;
  out.direction = message.direction;
  return out;
}

kiva::Command fromMessage(const warehouse_msgs::Lift& message) {
  kiva::Command out;
  out.kind = kiva::Command::Kind::kLift;
  out.kiva_id = message.kiva_id;
  out.lift = message.status;
  out.shelf_id = message.shelf_id;
  return out;
}

warehouse_msgs::MoveTo toMoveTo(const kiva::Command& command) {
  warehouse_msgs::MoveTo out;
  out.x = command.x;
  out.y = command.y;
  out.kiva_id = command.kiva_id;
  return out;
}

warehouse_msgs::MoveAlong toMoveAlong(const kiva::Command& command) {
  warehouse_msgs::MoveAlong out;
  out.distance = command.kind == kiva::Command::Kind::kMoveX ? command.x : command.y;
  out.kiva_id = command.kiva_id;
  return out;
}

warehouse_msgs::Rotate toRotate(const kiva::Command& command) {
  warehouse_msgs::Rotate out;
  out.direction = static_cast<std::int8_t>(command.direction);
  out.kiva_id = command.kiva_id;
  return out;
}

warehouse_msgs::Lift toLift(const kiva::Command& command) {
  warehouse_msgs::Lift out;
  out.status = static_cast<std::uint8_t>(command.lift);
  out.kiva_id = command.kiva_id;
  out.shelf_id = command.shelf_id;
  return out;
}

}  // namespace kiva_ros
