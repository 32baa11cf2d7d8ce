// SPDX-License-Identifier: Apache-2.0
#include "warehouse_messages.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "core/geometry/angle.h"
#include "ros/messages/convert.h"

namespace kiva_ros {
namespace {

using warehouse_msgs::KivaStatus;

// Variance of motions that wheels do not measure and that a level floor prevents [m², rad²].
constexpr double kOffTheFloor = 1e-6;

std::string robotName(int id) { return "kiva" + std::to_string(id); }

/// Returns the number in `kiva<id>` of the robot at that index, 0 for -1.
int idOf(const kiva::Fleet& fleet, int robot) { return robot < 0 ? 0 : fleet.robots[robot].id; }

int shelfOf(const kiva::World& world, int robot) {
  const int unit = world.fleet().unit[robot];
  return unit < 0 ? 0 : world.storageUnits()[unit].id;
}

/// Writes the covariance of some of x, y, z, roll, pitch, yaw, given by their indices.
template <std::size_t N, std::size_t Size>
void write(const std::array<double, Size>& covariance, const std::array<int, N>& places,
           boost::array<double, 36>* out) {
  for (int axis = 0; axis < 6; ++axis) (*out)[7 * axis] = kOffTheFloor;
  for (std::size_t i = 0; i < N; ++i) {
    for (std::size_t j = 0; j < N; ++j) {
      (*out)[6 * places[i] + places[j]] = covariance[N * i + j];
    }
  }
}

void overwrite(const kiva::RobotReport& last, int i, warehouse_msgs::FleetState* out) {
  out->x[i] = last.x;
  out->y[i] = last.y;
  out->yaw[i] = kiva::wrapAngle(last.yaw);
  out->vx[i] = last.vx;
  out->vy[i] = last.vy;
  out->yaw_rate[i] = last.yaw_rate;
  out->status[i] = static_cast<std::uint8_t>(last.status);
  out->state[i] = static_cast<std::uint8_t>(last.state);
  out->shelf_id[i] = last.shelf_id;
  out->path_id[i] = last.path_id;
  out->reached[i] = last.reached;
  out->left[i] = last.left;
  out->last_end[i] = last.last_end;
}

void overwrite(const kiva::PlanarTwist& twist, int i, warehouse_msgs::FleetState* out) {
  out->vx[i] = twist.vx;
  out->vy[i] = twist.vy;
  out->yaw_rate[i] = twist.yaw_rate;
}

void addFallen(const kiva::World& world, warehouse_msgs::WarehouseObjects* out) {
  const auto index = [](const std::vector<std::string>& names, const std::string& name) {
    return static_cast<int>(std::find(names.begin(), names.end(), name) - names.begin());
  };
  for (const kiva::FallenItem& fallen : world.fallenItems()) {
    out->fallen_item.push_back(index(out->items, fallen.name));
    out->fallen_from.push_back(index(out->storage_units, fallen.unit));
  }
}

}  // namespace

warehouse_msgs::Event toMessage(const kiva::Event& event) {
  warehouse_msgs::Event out;
  out.header = header(event.time, "world");
  out.kind = static_cast<std::uint8_t>(event.kind);
  out.model = event.model;
  out.other = event.other;
  out.text = event.text;
  out.command = event.command;
  return out;
}

warehouse_msgs::Collision toCollision(const kiva::Event& event) {
  warehouse_msgs::Collision out;
  out.header = header(event.time, "world");
  out.model = event.model;
  out.other = event.other;
  out.point.x = event.impact.point.X();
  out.point.y = event.impact.point.Y();
  out.point.z = event.impact.point.Z();
  out.normal = toMessage(event.impact.normal);
  out.speed = event.impact.speed;
  out.impulse = event.impact.impulse;
  return out;
}

warehouse_msgs::KivaStatus toMessage(const kiva::StatusChange& status) {
  warehouse_msgs::KivaStatus out;
  out.header = header(status.time, "world");
  out.kiva_id = status.kiva_id;
  out.status = static_cast<std::uint8_t>(status.status);
  out.state = static_cast<std::uint8_t>(status.state);
  out.shelf_id = status.shelf_id;
  out.pose.x = status.x;
  out.pose.y = status.y;
  out.pose.theta = kiva::wrapAngle(status.yaw);
  return out;
}

sensor_msgs::LaserScan toMessage(const Scan& scan, const kiva::LaserParameters& laser,
                                 double time) {
  sensor_msgs::LaserScan out;
  out.header = header(time, robotName(scan.kiva_id) + "/laser");
  out.angle_min = static_cast<float>(laser.min_angle);
  out.angle_max = static_cast<float>(laser.max_angle);
  const int gaps = std::max(laser.rays - 1, 1);
  out.angle_increment = static_cast<float>((laser.max_angle - laser.min_angle) / gaps);
  out.scan_time = static_cast<float>(1 / laser.rate);
  out.range_min = static_cast<float>(laser.min_range);
  out.range_max = static_cast<float>(laser.max_range);
  out.ranges = scan.ranges;
  return out;
}

nav_msgs::Odometry toMessage(const RobotPose& robot, double time) {
  nav_msgs::Odometry out;
  const std::string name = robotName(robot.kiva_id);
  out.header = header(time, robot.counted ? name + "/odom" : "world");
  out.child_frame_id = name + "/base_link";
  out.pose.pose = toMessage(robot.base);
  out.twist.twist = toMessage(robot.twist);
  if (robot.is_exact) return out;
  write<3>(robot.pose_covariance, {0, 1, 5}, &out.pose.covariance);
  write<2>(robot.twist_covariance, {0, 5}, &out.twist.covariance);
  return out;
}

kiva::StatusChange statusOf(const kiva::World& world, int robot) {
  const kiva::Fleet& f = world.fleet();
  if (const auto last = world.lastHeard(robot)) {
    return {world.time(), f.robots[robot].id, last->status, last->state, last->shelf_id, last->x,
            last->y,      last->yaw};
  }
  return {world.time(),          f.robots[robot].id, f.status[robot], f.state[robot],
          shelfOf(world, robot), f.x[robot],         f.y[robot],      f.yaw[robot]};
}

warehouse_msgs::FleetState fleetState(const kiva::World& world) {
  const kiva::Fleet& f = world.fleet();
  warehouse_msgs::FleetState out;
  out.stamp = ros::Time(world.time());
  out.x.assign(f.x.begin(), f.x.end());
  out.y.assign(f.y.begin(), f.y.end());
  out.vx.assign(f.vx.begin(), f.vx.end());
  out.vy.assign(f.vy.begin(), f.vy.end());
  out.yaw_rate.assign(f.yaw_rate.begin(), f.yaw_rate.end());
  out.path_id.assign(f.path_id.begin(), f.path_id.end());
  out.reached.assign(f.reached.begin(), f.reached.end());
  out.left.assign(f.left.begin(), f.left.end());
  out.last_end.assign(f.last_end.begin(), f.last_end.end());
  out.failures.assign(f.failures.begin(), f.failures.end());
  out.charge.assign(f.charge.begin(), f.charge.end());
  out.mode.assign(f.mode.begin(), f.mode.end());
  const bool has_limits = world.realism().loads.enabled;
  for (int i = 0; i < f.size(); ++i) {
    if (has_limits) out.load_limit.push_back(static_cast<float>(world.loadLimit(i)));
    out.kiva_id.push_back(f.robots[i].id);
    out.yaw.push_back(kiva::wrapAngle(f.yaw[i]));
    out.status.push_back(static_cast<std::uint8_t>(f.status[i]));
    out.state.push_back(static_cast<std::uint8_t>(f.state[i]));
    out.shelf_id.push_back(shelfOf(world, i));
    if (const auto last = world.lastHeard(i)) overwrite(*last, i, &out);
    if (const auto twist = world.shadowTwist(i)) overwrite(*twist, i, &out);
  }
  return out;
}

warehouse_msgs::People peopleMessage(const kiva::World& world) {
  warehouse_msgs::People out;
  out.stamp = ros::Time(world.time());
  const std::vector<kiva::Person> people = world.people();
  if (people.empty()) return out;
  for (const kiva::Person& person : people) {
    out.name.push_back(person.name);
    out.x.push_back(person.x);
    out.y.push_back(person.y);
    out.vx.push_back(person.vx);
    out.vy.push_back(person.vy);
    out.ahead_x.push_back(person.ahead_x);
    out.ahead_y.push_back(person.ahead_y);
  }
  const kiva::Fleet& f = world.fleet();
  for (int i = 0; i < f.size(); ++i) {
    const bool stands = f.curtained[i] != 0 || f.allowed_speed[i] == 0;
    if (stands) out.stopped.push_back(f.robots[i].id);
    if (!stands && std::isfinite(f.allowed_speed[i])) out.slowed.push_back(f.robots[i].id);
  }
  return out;
}

warehouse_msgs::WarehouseObjects warehouseObjects(const kiva::World& world) {
  warehouse_msgs::WarehouseObjects out;
  out.header = header(world.time(), "world");
  out.revision = static_cast<std::uint32_t>(world.modelsRevision());
  for (const kiva::StorageUnit& unit : world.storageUnits()) out.storage_units.push_back(unit.name);
  const auto& items = world.items();
  for (std::size_t i = 0; i < items.size(); ++i) {
    out.items.push_back(items[i].name);
    out.item_unit.push_back(items[i].unit);
    const int index = static_cast<int>(i);
    append(items[i].unit < 0 ? world.itemPose(index) : items[i].pose_in_unit, &out.item_pose);
  }
  addFallen(world, &out);
  for (const std::string& name : world.modelNames()) {
    if (world.kind(name) == kiva::ModelKind::kBelt) out.belts.push_back(name);
  }
  for (const kiva::Robot& robot : world.fleet().robots) out.kiva_id.push_back(robot.id);
  return out;
}

warehouse_msgs::UnitStates unitStates(const kiva::World& world) {
  warehouse_msgs::UnitStates out;
  out.header = header(world.time(), "world");
  out.revision = static_cast<std::uint32_t>(world.modelsRevision());
  const auto& units = world.storageUnits();
  for (std::size_t i = 0; i < units.size(); ++i) {
    append(world.storageUnitPose(static_cast<int>(i)), &out.pose);
    out.carrier.push_back(idOf(world.fleet(), units[i].carrier));
  }
  const auto& items = world.items();
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (items[i].unit >= 0) continue;
    out.loose_item.push_back(static_cast<int>(i));
    append(world.itemPose(static_cast<int>(i)), &out.loose_pose);
  }
  return out;
}

}  // namespace kiva_ros
