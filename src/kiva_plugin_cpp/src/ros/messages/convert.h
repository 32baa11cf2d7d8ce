// SPDX-License-Identifier: Apache-2.0
//
// Converts between common messages and the world's structs.
#pragma once

#include <gazebo_msgs/ModelState.h>
#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Transform.h>
#include <geometry_msgs/TransformStamped.h>
#include <geometry_msgs/Twist.h>
#include <geometry_msgs/Vector3.h>
#include <geometry_msgs/Wrench.h>
#include <std_msgs/Header.h>

#include <string>
#include <vector>

#include "kiva_plugin_cpp/world.h"

namespace kiva_ros {

// --- world to message
std_msgs::Header header(double time, const std::string& frame);
geometry_msgs::Vector3 toMessage(const kiva::Vector3& vector);
geometry_msgs::Pose toMessage(const kiva::Pose& pose);
geometry_msgs::Twist toMessage(const kiva::Twist& twist);
geometry_msgs::Transform toTransform(const kiva::Pose& pose);
/// Returns the transform of frame `child` in frame `parent`, at `time` [s].
geometry_msgs::TransformStamped transform(double time, const std::string& parent,
                                          const std::string& child, const kiva::Pose& pose);
/// Appends a pose in the layout of arrays in messages: x y z, then the quaternion x y z w.
void append(const kiva::Pose& pose, std::vector<double>* out);

// --- message to world
/// Converts a pose; a quaternion of zeros is identity, as clients expect. Throws
/// std::invalid_argument if a number is not finite.
kiva::Pose fromMessage(const geometry_msgs::Pose& pose);
kiva::Vector3 fromMessage(const geometry_msgs::Vector3& vector, const char* what);
kiva::Vector3 fromMessage(const geometry_msgs::Point& point, const char* what);
kiva::Twist fromMessage(const geometry_msgs::Twist& twist);
kiva::EntityState fromMessage(const gazebo_msgs::ModelState& state);
/// Returns the state's hash as text: the steps since time was 0, a blank, 16 hexadecimal digits.
std::string hashText(const kiva::World& world);

}  // namespace kiva_ros
