// SPDX-License-Identifier: Apache-2.0
#include "ros/gazebo_plugins/rays/ray_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace kiva_ros {
namespace {

constexpr int kMostRays = 250000;
constexpr double kMostRange = 1e5;  // [m]

}  // namespace

RayGrid::RayGrid(const kiva::SensorDescription& sensor) {
  const kiva::Parameters& s = sensor.parameters;
  const std::string ray = s.has("lidar/range/max") ? "lidar/" : "ray/";
  const auto read = [&](const std::string& scan, Axis* axis, double most) {
    axis->samples = s.whole(scan + "samples", axis->samples, 1, kMostRays);
    axis->least = s.number(scan + "min_angle", 0, -most, most);
    axis->most = s.number(scan + "max_angle", 0, axis->least, axis->least + 2 * most);
  };
  across.samples = 640;
  read(ray + "scan/horizontal/", &across, 2 * M_PI);
  read(ray + "scan/vertical/", &up, M_PI / 2);
  if (up.samples > kMostRays / across.samples) {
    throw kiva::DescriptionError(s.where() + ": " + std::to_string(across.samples) + " x " +
                                 std::to_string(up.samples) + " samples are more than " +
                                 std::to_string(kMostRays) + " rays");
  }
  min_range = s.number(ray + "range/min", 0, 0, kMostRange);
  max_range =
      std::min(s.number(ray + "range/max", 0, 0, std::numeric_limits<double>::max()), kMostRange);
  noise = s.number(ray + "noise/stddev", 0, 0, kMostRange);
}

std::vector<kiva::Vector3> RayGrid::directions() const {
  std::vector<kiva::Vector3> out;
  out.reserve(size());
  for (int row = 0; row < up.samples; ++row) {
    const double pitch = up.angle(row);
    for (int column = 0; column < across.samples; ++column) {
      const double yaw = across.angle(column);
      out.emplace_back(std::cos(pitch) * std::cos(yaw), std::cos(pitch) * std::sin(yaw),
                       std::sin(pitch));
    }
  }
  return out;
}

std::vector<double> castFrom(const kiva::World& world, const kiva::Pose& pose,
                             const std::vector<kiva::Vector3>& directions, double range,
                             const std::string& but) {
  std::vector<kiva::Vector3> turned;
  turned.reserve(directions.size());
  for (const kiva::Vector3& direction : directions) {
    turned.push_back(pose.Rot() * direction);
  }
  std::vector<double> out;
  world.rayCast(pose.Pos(), turned, range, but, &out);
  return out;
}

}  // namespace kiva_ros
