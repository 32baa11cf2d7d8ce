// SPDX-License-Identifier: Apache-2.0
#include "core/motion/driving/dead_reckoning.h"

#include <cmath>

namespace kiva {
namespace {

// Way and turn over which uncertainty grows as on one arc.
constexpr double kPart = 0.1;      // [m]
constexpr double kPartTurn = 0.1;  // [rad]

/// Returns the pose of `to` in the frame `from`.
PlanarPose relative(const PlanarPose& from, const PlanarPose& to) {
  const double c = std::cos(from.yaw), s = std::sin(from.yaw);
  const double dx = to.x - from.x, dy = to.y - from.y;
  return {c * dx + s * dy, c * dy - s * dx, to.yaw - from.yaw};
}

/// Returns the frame in which the pose `in_world` is `local`.
PlanarPose frameOf(const PlanarPose& in_world, const PlanarPose& local) {
  const double yaw = in_world.yaw - local.yaw, c = std::cos(yaw), s = std::sin(yaw);
  return {in_world.x - (c * local.x - s * local.y), in_world.y - (s * local.x + c * local.y), yaw};
}

/// Makes the pose certain; what is known of the wheels stays.
void makeCertain(Localisation* l) {
  constexpr int n = Localisation::kStates;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < n; ++j) l->covariance[i * n + j] = l->covariance[j * n + i] = 0;
  }
  l->way = l->turn = l->since_code = 0;
}

}  // namespace

void beginOdometry(RobotView& world, int robot) {
  FleetState& f = world.fleet;
  if (f.localises) makeCertain(&f.localisation[robot]);
  f.steering(robot).origin = f.believed(robot);
}

PlanarPose countedPose(const FleetState& f, int robot) {
  return relative(f.steering(robot).origin, f.believed(robot));
}

void keepOdometry(RobotView& world, int robot, const PlanarPose& counted) {
  FleetState& f = world.fleet;
  f.steering(robot).origin = frameOf(f.believed(robot), counted);
}

void growUncertainty(RobotView& world, int robot) {
  const LocalisationRealism& real = world.settings.realism.localisation;
  Localisation& l = world.fleet.localisation[robot];
  if (std::abs(l.way) < kPart && std::abs(l.turn) < kPartTurn) return;
  l.propagate(real.slip, real.wheel_separation_error);
}

void makeLocal(const FleetState& f, int robot, Odometry* odometry) {
  const PlanarPose at = countedPose(f, robot);
  odometry->is_local = true;
  odometry->pose = {at.x, at.y, at.yaw};
  const double yaw = f.steering(robot).origin.yaw, c = std::cos(yaw), s = std::sin(yaw);
  const double turn[3][3] = {{c, s, 0}, {-s, c, 0}, {0, 0, 1}};
  const std::array<double, 9> in_world = odometry->pose_covariance;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      double sum = 0;
      for (int k = 0; k < 3; ++k) {
        for (int l = 0; l < 3; ++l) sum += turn[i][k] * in_world[3 * k + l] * turn[j][l];
      }
      odometry->pose_covariance[3 * i + j] = sum;
    }
  }
}

}  // namespace kiva
