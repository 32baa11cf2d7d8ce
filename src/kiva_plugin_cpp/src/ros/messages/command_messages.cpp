// SPDX-License-Identifier: Apache-2.0
#include "command_messages.h"

#include <algorithm>
#include <cstdio>
#include <iterator>
#include <numeric>
#include <string>
#include <utility>

namespace kiva_ros {
namespace {

/// Returns the fault of a message's arrays; empty if they agree.
std::string disagreement(const warehouse_msgs::FleetFollow& m) {
  const std::size_t robots = m.kiva_id.size();
  char text[200];
  for (const auto* column : {&m.path_id, &m.first, &m.points, &m.released}) {
    if (column->size() == robots) continue;
    std::snprintf(text, sizeof text,
                  "a FleetFollow of %zu kiva_id, %zu path_id, %zu first, %zu points and %zu "
                  "released: as many of each were expected",
                  robots, m.path_id.size(), m.first.size(), m.points.size(), m.released.size());
    return text;
  }
  const std::size_t points = std::accumulate(m.points.begin(), m.points.end(), std::size_t{0});
  if (m.x.size() == points && m.y.size() == points) return "";
  std::snprintf(text, sizeof text,
                "a FleetFollow of %zu points with %zu x and %zu y: as many of each were expected",
                points, m.x.size(), m.y.size());
  return text;
}

}  // namespace

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

kiva::Command fromMessage(const warehouse_msgs::Cancel& message) {
  kiva::Command out;
  out.kind = kiva::Command::Kind::kCancel;
  out.kiva_id = message.kiva_id;
  return out;
}

kiva::Command fromMessage(const warehouse_msgs::Stop& message) {
  kiva::Command out;
  out.kind = message.stop ? kiva::Command::Kind::kStop : kiva::Command::Kind::kGoOn;
  out.kiva_id = message.kiva_id;
  return out;
}

kiva::FollowPath fromMessage(const warehouse_msgs::FollowPath& message) {
  kiva::FollowPath out;
  out.kiva_id = message.kiva_id;
  out.path_id = message.path_id;
  out.first = message.first;
  out.x = message.x;
  out.y = message.y;
  out.released = message.released;
  return out;
}

kiva::FollowPath fromMessage(const warehouse_msgs::LimitedPath& message) {
  kiva::FollowPath out = fromMessage(message.path);
  out.max_speed = message.max_speed;
  return out;
}

Orders fromMessage(const warehouse_msgs::FleetFollow& message) {
  Orders out;
  kiva::FollowPath wrong;
  wrong.fault = disagreement(message);
  if (!wrong.fault.empty()) return {wrong};
  out.reserve(message.kiva_id.size());
  auto x = message.x.begin(), y = message.y.begin();
  for (std::size_t i = 0; i < message.kiva_id.size(); ++i) {
    const std::uint32_t points = message.points[i];
    kiva::FollowPath path;
    path.kiva_id = message.kiva_id[i];
    path.path_id = message.path_id[i];
    path.first = message.first[i];
    path.x.assign(x, x + points);
    path.y.assign(y, y + points);
    path.released = message.released[i];
    x += points;
    y += points;
    out.emplace_back(std::move(path));
  }
  return out;
}

Orders fromMessage(const warehouse_msgs::FleetOrders& message) {
  Orders out;
  for (const auto& cancel : message.cancels) out.emplace_back(fromMessage(cancel));
  Orders paths = fromMessage(message.follow);
  std::move(paths.begin(), paths.end(), std::back_inserter(out));
  for (const auto& lift : message.lifts) out.emplace_back(fromMessage(lift));
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

warehouse_msgs::Cancel toCancel(const kiva::Command& command) {
  warehouse_msgs::Cancel out;
  out.kiva_id = command.kiva_id;
  return out;
}

warehouse_msgs::Stop toStop(const kiva::Command& command) {
  warehouse_msgs::Stop out;
  out.kiva_id = command.kiva_id;
  out.stop = command.kind == kiva::Command::Kind::kStop;
  return out;
}

warehouse_msgs::FollowPath toMessage(const kiva::FollowPath& path) {
  warehouse_msgs::FollowPath out;
  out.kiva_id = path.kiva_id;
  out.path_id = path.path_id;
  out.first = path.first;
  out.x = path.x;
  out.y = path.y;
  out.released = path.released;
  return out;
}

warehouse_msgs::LimitedPath toLimitedPath(const kiva::FollowPath& path) {
  warehouse_msgs::LimitedPath out;
  out.path = toMessage(path);
  out.max_speed = path.max_speed;
  return out;
}

}  // namespace kiva_ros
