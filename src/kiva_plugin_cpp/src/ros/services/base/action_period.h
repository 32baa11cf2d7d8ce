// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/duration.h>
#include <ros/time.h>

#include <algorithm>
#include <limits>
#include <stdexcept>
#include <string>

#include "kiva_plugin_cpp/world.h"

namespace kiva_ros {

/// Returns a period as Gazebo's clients mean it: a start in the past is now, a negative duration is
/// unlimited, and the shortest duration is one step.
inline kiva::Period periodOf(const kiva::World& world, const ros::Time& start_time,
                             const ros::Duration& duration) {
  const double start = std::max(start_time.toSec(), world.time());
  const double length = duration.toSec();
  const double end = length < 0 ? std::numeric_limits<double>::infinity()
                                : start + std::max(length, world.stepSize());
  return {start, end};
}

/// Throws std::invalid_argument for a force or torque so large that velocities would become
/// infinite.
inline void checkSize(double size, const std::string& what) {
  constexpr double kMost = 1e9;  // [N, Nm]
  if (!(size <= kMost)) throw std::invalid_argument("the " + what + " must be below 1e9 N or Nm");
}

}  // namespace kiva_ros
