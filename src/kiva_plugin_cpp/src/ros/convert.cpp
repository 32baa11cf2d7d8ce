// SPDX-License-Identifier: Apache-2.0
#include "convert.h"

#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace kiva_ros {
namespace {

using warehouse_msgs::KivaStatus;
static_assert(int(kiva::Status::kBlocked) == int(KivaStatus::STATUS_BLOCKED));
static_assert(int(kiva::State::kMovingX) == int(KivaStatus::STATE_MOVING_X));
static_assert(int(kiva::State::kBlocked) == int(KivaStatus::STATE_BLOCKED));
static_assert(int(kiva::Event::Kind::kRefused) == int(warehouse_msgs::Event::REFUSED));
static_assert(int(kiva::Event::Kind::kDeleted) == int(warehouse_msgs::Event::DELETED));

std::string robotName(int id) { return "kiva" + std::to_string(id); }

/// The world counts full turns; clients expect -π…π.
double wrapped(double angle) { return std::remainder(angle, 2 * M_PI); }

void append(const kiva::Pose& pose, std::vector<double>* out) {
  const auto& p = pose.Pos();
  const auto& q = pose.Rot();
  out->insert(out->end(), {p.X(), p.Y(), p.Z(), q.X(), q.Y(), q.Z(), q.W()});
}

/// The number in `kiva<id>` of the robot at that index, 0 for none.
int idOf(const kiva::Fleet& fleet, int robot) { return robot < 0 ? 0 : fleet.robots[robot].id; }

int shelfOf(const kiva::World& world, int robot) {
  const int unit = world.fleet().unit[robot];
  return unit < 0 ? 0 : world.storageUnits()[unit].id;
}

template <typename Vector>
kiva::Vector3 vectorFrom(const Vector& v, const char* what) {
  if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z)) {
    throw std::invalid_argument(std::string(what) + " is not finite");
  }
  return {v.x, v.y, v.z};
}

kiva::Quaternion rotationFrom(const geometry_msgs::Quaternion& q) {
  const double norm = std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  if (!std::isfinite(norm)) throw std::invalid_argument("orientation is not finite");
  if (norm < 1e-9) return kiva::Quaternion::Identity;
  return {q.w / norm, q.x / norm, q.y / norm, q.z / norm};
}

}  // namespace

std_msgs::Header header(double time, const std::string& frame) {
  std_msgs::Header out;
  out.stamp = ros::Time(time);
  out.frame_id = frame;
  return out;
}

geometry_msgs::Vector3 toMessage(const kiva::Vector3& vector) {
  geometry_msgs::Vector3 out;
  out.x = vector.X();
  out.y = vector.Y();
  out.z = vector.Z();
  return out;
}

geometry_msgs::Transform toTransform(const kiva::Pose& pose) {
  geometry_msgs::Transform out;
  out.translation = toMessage(pose.Pos());
  out.rotation.x = pose.Rot().X();
  out.rotation.y = pose.Rot().Y();
  out.rotation.z = pose.Rot().Z();
  out.rotation.w = pose.Rot().W();
  return out;
}

geometry_msgs::TransformStamped transform(double time, const std::string& parent,
                                          const std::string& child, const kiva::Pose& pose) {
  geometry_msgs::TransformStamped out;
  out.header = header(time, parent);
  out.child_frame_id = child;
  out.transform = toTransform(pose);
  return out;
}

geometry_msgs::Pose toMessage(const kiva::Pose& pose) {
  geometry_msgs::Pose out;
  const geometry_msgs::Transform transform = toTransform(pose);
  out.position.x = transform.translation.x;
  out.position.y = transform.translation.y;
  out.position.z = transform.translation.z;
  out.orientation = transform.rotation;
  return out;
}

geometry_msgs::Twist toMessage(const kiva::Twist& twist) {
  geometry_msgs::Twist out;
  out.linear = toMessage(twist.linear);
  out.angular = toMessage(twist.angular);
  return out;
}

warehouse_msgs::Event toMessage(const kiva::Event& event) {
  warehouse_msgs::Event out;
  out.header = header(event.time, "world");
  out.kind = static_cast<std::uint8_t>(event.kind);
  out.model = event.model;
  out.other = event.other;
  out.text = event.text;
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
  out.pose.theta = wrapped(status.yaw);
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
  out.header = header(time, "world");
  out.child_frame_id = robotName(robot.kiva_id) + "/base_link";
  out.pose.pose = toMessage(robot.base);
  out.twist.twist = toMessage(robot.twist);
  return out;
}

kiva::StatusChange statusOf(const kiva::World& world, int robot) {
  const kiva::Fleet& f = world.fleet();
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
  for (int i = 0; i < f.size(); ++i) {
    out.kiva_id.push_back(f.robots[i].id);
    out.yaw.push_back(wrapped(f.yaw[i]));
    out.status.push_back(static_cast<std::uint8_t>(f.status[i]));
    out.state.push_back(static_cast<std::uint8_t>(f.state[i]));
    out.shelf_id.push_back(shelfOf(world, i));
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

kiva::Pose fromMessage(const geometry_msgs::Pose& pose) {
  return {vectorFrom(pose.position, "position"), rotationFrom(pose.orientation)};
}

kiva::Vector3 fromMessage(const geometry_msgs::Vector3& vector, const char* what) {
  return vectorFrom(vector, what);
}

kiva::Vector3 fromMessage(const geometry_msgs::Point& point, const char* what) {
  return vectorFrom(point, what);
}

kiva::Twist fromMessage(const geometry_msgs::Twist& twist) {
  return {vectorFrom(twist.linear, "linear velocity"),
          vectorFrom(twist.angular, "angular velocity")};
}

kiva::EntityState fromMessage(const gazebo_msgs::ModelState& state) {
  return {fromMessage(state.pose), fromMessage(state.twist)};
}

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

std::string hashText(const kiva::World& world) {
  char text[64];
  std::snprintf(text, sizeof text, "%" PRIu64 " %016" PRIx64, world.steps(), world.stateHash());
  return text;
}

}  // namespace kiva_ros
