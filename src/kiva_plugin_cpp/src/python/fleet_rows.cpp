// SPDX-License-Identifier: Apache-2.0
#include "fleet_rows.h"

#include <algorithm>
#include <type_traits>

namespace kiva::python {

FleetRows::FleetRows(std::size_t size) {
  for (Column<double>* c :
       {&x, &y, &yaw, &vx, &vy, &yaw_rate, &left_wheel_speed, &right_wheel_speed, &tower}) {
    c->resize(size);
  }
  for (Column<std::uint8_t>* c : {&status, &state, &last_end}) c->resize(size);
  shelf_id.resize(size);
  counts.resize(size * Event::kKinds);
}

void FleetRows::take(const World& world, std::size_t at, int begin, int end) {
  const Fleet& f = world.fleet();
  const auto first = static_cast<std::ptrdiff_t>(at) + begin;
  const auto copy = [&](const auto& from, auto& to) {
    std::transform(from.begin() + begin, from.begin() + end, to.begin() + first, [](auto value) {
      return static_cast<typename std::decay_t<decltype(to)>::value_type>(value);
    });
  };
  copy(f.x, x);
  copy(f.y, y);
  copy(f.yaw, yaw);
  copy(f.vx, vx);
  copy(f.vy, vy);
  copy(f.yaw_rate, yaw_rate);
  copy(f.wheel_speed[0], left_wheel_speed);
  copy(f.wheel_speed[1], right_wheel_speed);
  copy(f.tower, tower);
  copy(f.status, status);
  copy(f.state, state);
  copy(f.last_end, last_end);
  std::transform(f.unit.begin() + begin, f.unit.begin() + end, shelf_id.begin() + first,
                 [&](int unit) { return unit < 0 ? 0 : world.storageUnits()[unit].id; });
}

}  // namespace kiva::python
