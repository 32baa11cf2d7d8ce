// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>

#include "kiva_plugin_cpp/geometry.h"

namespace kiva {

/// What a robot's own odometry says, and how uncertain that is. All covariances are 0 unless
/// localisation is realistic.
struct Odometry {
  Vector3 pose;           ///< (x, y, yaw) in world [m, rad], yaw unwrapped.
  bool is_local = false;  ///< In place of world, the pose is in a steered robot's own frame.
  std::array<double, 9> pose_covariance{};   ///< Covariance of x, y, yaw, row by row.
  double speed = 0;                          ///< Ahead [m/s].
  double turn_rate = 0;                      ///< [rad/s]
  std::array<double, 4> twist_covariance{};  ///< Covariance of speed and turn rate, row by row.
};

}  // namespace kiva
