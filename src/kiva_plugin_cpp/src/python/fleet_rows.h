// SPDX-License-Identifier: Apache-2.0
//
// The robots of many worlds in common arrays.
#pragma once

#include <cstddef>
#include <cstdint>

#include "arrays.h"
#include "host.h"

namespace kiva::python {

/// The robots of all worlds; rows are worlds.
struct FleetRows {
  Column<double> x, y, yaw, vx, vy, yaw_rate, left_wheel_speed, right_wheel_speed, tower;
  Column<std::uint8_t> status, state, last_end;
  Column<std::int32_t> shelf_id;
  Column<std::uint32_t> counts;  ///< counts of events: Event::kKinds a robot

  /// Makes room for `size` robots.
  explicit FleetRows(std::size_t size);

  /// Copies a world's robots, from `begin` to before `end`; its first one's place is `at`.
  void take(const World& world, std::size_t at, int begin, int end);
};

}  // namespace kiva::python
