// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "kiva_plugin_cpp/description.h"
#include "kiva_plugin_cpp/world.h"

namespace kiva_ros {

/// The rays of a <sensor type="ray">: rows from below to above, each from right to left.
struct RayGrid {
  /// Throws DescriptionError where a number is out of range.
  explicit RayGrid(const kiva::SensorDescription& sensor);
  RayGrid() = default;

  struct Axis {
    int samples = 1;
    double least = 0, most = 0;  ///< Angles [rad].
    double gap() const { return samples > 1 ? (most - least) / (samples - 1) : 0; }
    double angle(int sample) const { return least + gap() * sample; }
  };
  Axis across;                          ///< Angles about the sensor's z.
  Axis up;                              ///< Above its xy plane.
  double min_range = 0, max_range = 0;  ///< [m]
  double noise = 0;                     ///< Standard deviation [m].

  int size() const { return across.samples * up.samples; }
  /// Returns unit vectors of all rays in the sensor's frame.
  std::vector<kiva::Vector3> directions() const;
};

/// Returns distances [m] along directions of a sensor at that pose in world; +inf = no return. Rays
/// pass through model `but`.
std::vector<double> castFrom(const kiva::World& world, const kiva::Pose& pose,
                             const std::vector<kiva::Vector3>& directions, double range,
                             const std::string& but);

}  // namespace kiva_ros
