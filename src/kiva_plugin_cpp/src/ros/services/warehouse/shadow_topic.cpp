// SPDX-License-Identifier: Apache-2.0
#include "ros/services/warehouse/shadow_topic.h"

#include <stdexcept>

namespace kiva_ros {
namespace {

constexpr double kWarnAgain = 10;  // [s], wall

/// Returns an element of one of a message's arrays, which may be empty.
template <typename Array, typename Value>
Value at(const Array& array, std::size_t i, Value otherwise) {
  return array.empty() ? otherwise : static_cast<Value>(array.at(i));
}

/// Throws std::out_of_range where an array is too short.
kiva::ShadowReport reportOf(const warehouse_msgs::FleetState& m, std::size_t i) {
  kiva::ShadowReport out;
  out.report.x = m.x.at(i);
  out.report.y = m.y.at(i);
  out.report.yaw = m.yaw.at(i);
  out.report.vx = at(m.vx, i, 0.0);
  out.report.vy = at(m.vy, i, 0.0);
  out.report.yaw_rate = at(m.yaw_rate, i, 0.0);
  out.report.status = static_cast<kiva::Status>(at(m.status, i, 0));
  out.report.state = static_cast<kiva::State>(at(m.state, i, 0));
  out.report.shelf_id = at(m.shelf_id, i, 0);
  out.report.path_id = at(m.path_id, i, 0u);
  out.report.reached = at(m.reached, i, 0u);
  out.report.left = at(m.left, i, 0u);
  out.report.last_end = at(m.last_end, i, std::uint8_t{0});
  out.failures = at(m.failures, i, std::uint8_t{0});
  out.charge = at(m.charge, i, 1.0f);
  if (out.report.status > kiva::Status::kBlocked || out.report.state > kiva::State::kSteered) {
    throw std::invalid_argument("a status or a state that does not exist");
  }
  return out;
}

void moveAll(kiva::World& world, const warehouse_msgs::FleetState& m) {
  for (std::size_t i = 0; i < m.kiva_id.size(); ++i) {
    try {
      world.shadow(m.kiva_id[i], reportOf(m, i));
    } catch (const std::exception& error) {
      ROS_WARN_THROTTLE(kWarnAgain, "/warehouse/shadows: kiva%d: %s", m.kiva_id[i], error.what());
    }
  }
}

}  // namespace

ShadowTopic::ShadowTopic(ros::NodeHandle& root, PluginInputs& inputs)
    : input_(inputs.subscribe<warehouse_msgs::FleetState>(root, "warehouse/shadows")) {}

bool ShadowTopic::beforeStep(kiva::World& world) {
  if (const warehouse_msgs::FleetState* message = input_.take()) moveAll(world, *message);
  return true;
}

}  // namespace kiva_ros
