// SPDX-License-Identifier: Apache-2.0
#include "kiva_plugin_cpp/fleet.h"

#include <limits>
#include <utility>

namespace kiva {
namespace {

/// Calls visit(array) for every array of numbers of the fleet.
template <typename Visit>
void forEachArray(Fleet& f, Visit visit) {
  for (auto* array : {&f.x, &f.y, &f.yaw, &f.vx, &f.vy, &f.yaw_rate, &f.tower}) visit(*array);
  for (int wheel = 0; wheel < 2; ++wheel) {
    visit(f.wheel_speed[wheel]);
    visit(f.wheel_angle[wheel]);
  }
  visit(f.stance);
  visit(f.unit);
  visit(f.status);
  visit(f.state);
  visit(f.last_end);
  visit(f.path_id);
  visit(f.reached);
  visit(f.left);
  visit(f.stopped);
  visit(f.failures);
  visit(f.charge);
  visit(f.allowed_speed);
  visit(f.mode);
  visit(f.curtained);
}

}  // namespace

int Fleet::add(Robot robot, double at_x, double at_y, double at_yaw) {
  const int i = size();
  forEachArray(*this, [](auto& array) { array.emplace_back(); });
  x[i] = at_x;
  y[i] = at_y;
  yaw[i] = at_yaw;
  unit[i] = -1;
  charge[i] = 1;
  allowed_speed[i] = std::numeric_limits<double>::infinity();
  if (robot.id >= static_cast<int>(index_of_id.size())) index_of_id.resize(robot.id + 1, -1);
  index_of_id[robot.id] = i;
  robots.push_back(std::move(robot));
  return i;
}

void Fleet::remove(int i) {
  index_of_id[robots[i].id] = -1;
  const auto drop = [i](auto& array) {
    array[i] = std::move(array.back());
    array.pop_back();
  };
  forEachArray(*this, drop);
  if (i < size() - 1) index_of_id[robots.back().id] = i;
  drop(robots);
}

}  // namespace kiva
