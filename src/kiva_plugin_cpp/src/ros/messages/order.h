// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <variant>
#include <vector>

#include "kiva_plugin_cpp/world.h"

namespace kiva_ros {

/// A client's order to a robot.
using Order = std::variant<kiva::Command, kiva::FollowPath>;
/// The orders of one message: mostly one.
using Orders = std::vector<Order>;

inline int robotOf(const Order& order) {
  return std::visit([](const auto& asked) { return asked.kiva_id; }, order);
}

}  // namespace kiva_ros
