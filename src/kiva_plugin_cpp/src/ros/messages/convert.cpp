// SPDX-License-Identifier: Apache-2.0
#include "convert.h"

#include <cinttypes>
#include <cmath>
#include <cstdio>
#include <stdexcept>

namespace kiva_ros {
namespace {

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

void append(const kiva::Pose& pose, std::vector<double>* out) {
  const auto& p = pose.Pos();
  const auto& q = pose.Rot();
  out->insert(out->end(), {p.X(), p.Y(), p.Z(), q.X(), q.Y(), q.Z(), q.W()});
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

std::string hashText(const kiva::World& world) {
  char text[64];
  std::snprintf(text, sizeof text, "%" PRIu64 " %016" PRIx64, world.steps(), world.stateHash());
  return text;
}

}  // namespace kiva_ros
