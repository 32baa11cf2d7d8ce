// SPDX-License-Identifier: Apache-2.0
#include "core/motion/driving/dead_reckoning.h"

#include <array>
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

/// Returns the error for each share of the separation, after the way since it was known.
PlanarPose carriedOn(const PlanarPose& error, const Localisation& l) {
  const double middle = l.pose.yaw - l.turn / 2, across = l.way * (error.yaw + l.turn / 2);
  return {error.x - across * std::sin(middle), error.y + across * std::cos(middle),
          error.yaw + l.turn};
}

void addSeparation(const Scene& world, int robot, std::array<double, 9>* covariance) {
  const FleetState& f = world.fleet;
  const double share = world.settings.realism.localisation.wheel_separation_error;
  const PlanarPose per_share = carriedOn(f.steering(robot).per_separation, f.localisation[robot]);
  const double error[3] = {share * per_share.x, share * per_share.y, share * per_share.yaw};
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) (*covariance)[3 * i + j] += error[i] * error[j];
  }
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
  f.steering(robot).per_separation = {};
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
  PlanarPose& error = world.fleet.steering(robot).per_separation;
  error = carriedOn(error, l);
  l.propagate(real.slip, 0);
}

void makeLocal(const Scene& world, int robot, Odometry* odometry) {
  const FleetState& f = world.fleet;
  const PlanarPose at = countedPose(f, robot);
  odometry->is_local = true;
  odometry->pose = {at.x, at.y, at.yaw};
  if (f.localises) addSeparation(world, robot, &odometry->pose_covariance);
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
