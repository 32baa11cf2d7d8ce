// SPDX-License-Identifier: Apache-2.0
#include "core/motion/driving/self_location.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "core/motion/driving/dead_reckoning.h"
#include "core/state/progress/tasks.h"
#include "core/state/world/random_stream.h"

namespace kiva {
namespace {

constexpr double kView = 0.05;         // [m] around the camera in which it sees a code's centre
constexpr double kSlipLength = 0.25;   // [m] over which a wheel's slip is constant
constexpr double kMostDeviations = 3;  // limit of drawn errors in standard deviations

RandomStream streamOf(RobotView& world, int robot, Matter matter) {
  Localisation& l = world.fleet.localisation[robot];
  return RandomStream(world.settings.options.seed, matter, world.fleet.robots[robot].id, l.draws++);
}

double deviation(RandomStream& random, double share) {
  return share * std::clamp(random.normal(), -kMostDeviations, kMostDeviations);
}

void keepTrackOf(const Fleet& f, int i, Localisation* l) {
  for (int wheel = 0; wheel < 2; ++wheel) l->wheel_angle[wheel] = f.wheel_angle[wheel][i];
}

struct Code {
  std::int32_t column, row;
  double x, y;  // in world [m]
};

Code nearestCode(const Scene& world, int robot) {
  const double cell = world.settings.grid_spacing;
  const double column = std::round(world.fleet.x[robot] / cell);
  const double row = std::round(world.fleet.y[robot] / cell);
  return {static_cast<std::int32_t>(column), static_cast<std::int32_t>(row), column * cell,
          row * cell};
}

}  // namespace

void calibrate(RobotView& world, int robot) {
  const LocalisationRealism& real = world.settings.realism.localisation;
  const DriveParameters& drive = world.fleet.robots[robot].drive;
  Localisation& l = world.fleet.localisation[robot];
  l = Localisation();
  RandomStream random = streamOf(world, robot, Matter::kCalibration);
  for (int wheel = 0; wheel < 2; ++wheel) {
    l.believed.radius[wheel] =
        drive.wheel_radius * (1 + deviation(random, real.wheel_radius_error));
  }
  l.believed.separation =
      drive.wheel_separation * (1 + deviation(random, real.wheel_separation_error));
  for (int state = 3; state < Localisation::kStates; ++state) {
    l.covariance[state * Localisation::kStates + state] =
        real.wheel_radius_error * real.wheel_radius_error;
  }
  relocate(world, robot);
}

void relocate(RobotView& world, int robot) {
  const LocalisationRealism& real = world.settings.realism.localisation;
  const FleetState& f = world.fleet;
  Localisation& l = world.fleet.localisation[robot];
  l.stretch = Stretch();
  keepTrackOf(f, robot, &l);
  RandomStream random = streamOf(world, robot, Matter::kCode);
  l.pose.x = f.x[robot] + deviation(random, real.code_position_noise);
  l.pose.y = f.y[robot] + deviation(random, real.code_position_noise);
  l.pose.yaw = f.yaw[robot] + deviation(random, real.code_angle_noise);
  constexpr int n = Localisation::kStates;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < n; ++j) l.covariance[i * n + j] = l.covariance[j * n + i] = 0;
    const double noise = i < 2 ? real.code_position_noise : real.code_angle_noise;
    l.covariance[i * n + i] = noise * noise;
  }
  l.way = l.turn = l.since_code = 0;
  l.lost_at = real.lost_after;
  l.lost = false;
  const Code code = nearestCode(world, robot);
  l.code_column = code.column;
  l.code_row = code.row;
}

void drawSlip(RobotView& world, int robot, double length) {
  const double slip = world.settings.realism.localisation.slip;
  Localisation& l = world.fleet.localisation[robot];
  l.slip_for = length;
  if (slip == 0) return;
  RandomStream random = streamOf(world, robot, Matter::kSlip);
  for (double& share : l.slip) share = deviation(random, slip / std::sqrt(length));
}

void track(TaskView& world, int robot) {
  const FleetState& f = world.fleet;
  Localisation& l = world.fleet.localisation[robot];
  if (f.wheel_angle[0][robot] != l.wheel_angle[0] || f.wheel_angle[1][robot] != l.wheel_angle[1]) {
    l.slip_for -= l.roll(f.wheel_angle[0][robot], f.wheel_angle[1][robot]);
    if (l.slip_for <= 0) drawSlip(world, robot, kSlipLength);
  }
  if (f.tasks[robot].isSteered()) return growUncertainty(world, robot);  // its client locates it
  readCode(world, robot, false);
  checkLost(world, robot);
}

void readCode(RobotView& world, int robot, bool stands) {
  const LocalisationRealism& real = world.settings.realism.localisation;
  const FleetState& f = world.fleet;
  Localisation& l = world.fleet.localisation[robot];
  const Code code = nearestCode(world, robot);
  const double off = std::max(std::abs(f.x[robot] - code.x), std::abs(f.y[robot] - code.y));
  if (off > kView) return;
  const bool is_new = code.column != l.code_column || code.row != l.code_row;
  if (!is_new && !stands) return;
  l.code_column = code.column;
  l.code_row = code.row;
  RandomStream random = streamOf(world, robot, Matter::kCode);
  if (random.chance(real.missed_codes)) return;
  const PlanarPose reading{f.x[robot] + real.code_position_noise * random.normal(),
                           f.y[robot] + real.code_position_noise * random.normal(),
                           f.yaw[robot] + real.code_angle_noise * random.normal()};
  l.propagate(real.slip, real.wheel_separation_error);
  l.correct(reading, real.code_position_noise, real.code_angle_noise);
  l.since_code = 0;
  l.lost_at = real.lost_after;
  l.lost = false;
}

namespace {

/// Returns the odometry in world, by the estimate that codes correct; without the uncertainty of a
/// steered robot's wheel separation, which makeLocal() adds.
Odometry estimateOf(const Scene& world, int robot) {
  const Fleet& fleet = world.fleet;
  const FleetState& f = world.fleet;
  Odometry out;
  const PlanarPose at = f.believed(robot);
  out.pose = {at.x, at.y, at.yaw};
  const double c = std::cos(at.yaw), s = std::sin(at.yaw);
  out.speed = c * fleet.vx[robot] + s * fleet.vy[robot];
  out.turn_rate = fleet.yaw_rate[robot];
  if (!f.localises) return out;
  const LocalisationRealism& real = world.settings.realism.localisation;
  Localisation l = f.localisation[robot];
  const double alike = l.stretch.under_way ? l.slip_for : kSlipLength;
  l.settle(f.reference[robot], f.wheel_angle[0][robot], f.wheel_angle[1][robot]);
  l.propagate(real.slip, f.tasks[robot].isSteered() ? 0 : real.wheel_separation_error);
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      out.pose_covariance[3 * i + j] = l.covariance[i * Localisation::kStates + j];
    }
  }
  const double rates[2] = {f.wheel_speed[0][robot], f.wheel_speed[1][robot]};
  double speeds[2];
  l.measure(rates, real.slip, alike, real.wheel_separation_error, speeds,
            out.twist_covariance.data());
  out.speed = speeds[0];
  out.turn_rate = speeds[1];
  return out;
}

}  // namespace

Odometry odometryOf(const Scene& world, int robot) {
  Odometry out = estimateOf(world, robot);
  if (world.fleet.tasks[robot].isSteered()) makeLocal(world, robot, &out);
  return out;
}

bool checkLost(TaskView& world, int robot) {
  Localisation& l = world.fleet.localisation[robot];
  if (l.since_code < l.lost_at) return false;
  l.lost = true;
  l.lost_at = l.since_code + world.settings.realism.localisation.lost_after;
  char text[80];
  std::snprintf(text, sizeof text, "is lost: it has read no code for %.1f m", l.since_code);
  reportCommand(world, world.log, Event::Kind::kLost, robot, "", text);
  haltRobot(world, robot, "", text);
  return true;
}

}  // namespace kiva
