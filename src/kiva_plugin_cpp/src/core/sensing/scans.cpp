// SPDX-License-Identifier: Apache-2.0
#include "core/sensing/scans.h"

#include <algorithm>
#include <cmath>

#include "core/state/world/random_stream.h"

namespace kiva {
namespace {

constexpr int kMostTogether = 16;

/// Returns the number of robots with successive ids that scan in the same step, if several have to.
/// They mostly stand side by side and see the same models, which then are in the processor's cache.
/// It is a power of two, so that robots' schedules seldom change as robots come and go.
int scanTogether(int robots, std::uint64_t period) {
  int together = 1;
  while (together < kMostTogether && 2 * together * period <= static_cast<std::uint64_t>(robots)) {
    together *= 2;
  }
  return together;
}

/// Rebuilds the rounds after robots were added or removed.
void arrangeScans(const Scene& world, Scans& scans) {
  scans.rounds.clear();
  scans.rounds_revision = world.models.revision;
  for (int i = 0; i < world.fleet.size(); ++i) {
    const Robot& robot = world.fleet.robots[i];
    if (!robot.laser.fitted) continue;
    const std::uint64_t period = scanPeriod(world.clock, robot);
    auto round = std::find_if(scans.rounds.begin(), scans.rounds.end(),
                              [&](const ScanRound& r) { return r.period == period; });
    if (round == scans.rounds.end()) {
      round = scans.rounds.insert(round, {period, {}});
      round->robots_at.resize(period);
    }
    // Weyl's sequence by the golden ratio spreads any set of ids evenly.
    const int group = robot.id / scanTogether(world.fleet.size(), period);
    const double spread = std::fmod(group * 0.6180339887498949, 1.0);
    const auto offset = static_cast<std::uint64_t>(spread * static_cast<double>(period));
    round->robots_at[(period - offset) % period].push_back(i);
  }
}

/// Adds the laser's errors. A ray's error depends on robot, step and ray alone, not on the reader.
void disturb(const Scene& world, const Robot& robot, FanHits* hits) {
  constexpr std::uint64_t kMostRays = 1 << 14;
  const LaserRealism& real = world.settings.realism.lasers;
  for (int ray = hits->first; ray <= hits->last; ++ray) {
    if (hits->model[ray] < 0) continue;
    RandomStream random(world.settings.options.seed, Matter::kLaser, robot.id,
                        world.clock.total_steps * kMostRays + ray);
    const bool is_dropped = random.chance(real.dropped_rays);
    double& range = hits->range[ray];
    range = std::max(0.0, range + real.range_noise * random.normal());
    if (is_dropped || range > robot.laser.max_range) hits->model[ray] = -1;
  }
}

}  // namespace

std::uint64_t scanPeriod(const Clock& clock, const Robot& robot) {
  return std::max<std::uint64_t>(1, std::llround(1 / (robot.laser.rate * clock.dt)));
}

bool isBlind(const FleetState& fleet, int robot) {
  return (fleet.failures[robot] & bitOf(Failure::kLaser)) != 0;
}

void findDueScans(const Scene& world, const FailureState& failures, Scans& scans) {
  if (scans.rounds_revision != world.models.revision) arrangeScans(world, scans);
  scans.due.clear();
  for (const ScanRound& round : scans.rounds) {
    const std::vector<int>& due = round.robots_at[world.clock.total_steps % round.period];
    scans.due.insert(scans.due.end(), due.begin(), due.end());
  }
  if (!failures.defects.empty()) {
    const auto is_blind = [&](int i) { return isBlind(world.fleet, i); };
    scans.due.erase(std::remove_if(scans.due.begin(), scans.due.end(), is_blind), scans.due.end());
  }
  if (scans.rounds.size() > 1) std::sort(scans.due.begin(), scans.due.end());
}

void setRays(Scans& scans, Robot* robot) {
  const LaserParameters& laser = robot->laser;
  const auto same = [&](const RayFan& fan) {
    return fan.rays == laser.rays && fan.min_angle == laser.min_angle &&
           fan.max_angle == laser.max_angle;
  };
  const auto at = std::find_if(scans.fans.begin(), scans.fans.end(), same);
  robot->ray_fan = static_cast<int>(at - scans.fans.begin());
  if (at != scans.fans.end()) return;
  scans.fans.push_back(fanOf(laser.rays, laser.min_angle, laser.max_angle));
}

RayFan fanOf(int rays, double min_angle, double max_angle) {
  RayFan fan{rays, min_angle, max_angle, {}, {}, {}};
  const double span = max_angle - min_angle;
  for (int ray = 0; ray < rays; ++ray) {
    const double angle = min_angle + (rays > 1 ? span * ray / (rays - 1) : 0);
    fan.c.push_back(std::cos(angle));
    fan.s.push_back(std::sin(angle));
    fan.per_aside.push_back(1 / std::max(1e-9, std::abs(fan.s.back())));
  }
  return fan;
}

Sensor sensorOf(const Scene& world, int robot) {
  const FleetState& f = world.fleet;
  const LaserParameters& laser = f.robots[robot].laser;
  const double c = std::cos(f.yaw[robot]), s = std::sin(f.yaw[robot]);
  return {f.x[robot] + c * laser.x, f.y[robot] + s * laser.x, world.floor.extent.z + laser.z, c, s};
}

void castRays(const Scene& world, const Scans& scans, int robot, const FanReach& reach,
              FanHits* hits) {
  const RayFan& fan = scans.fans[world.fleet.robots[robot].ray_fan];
  world.obstacles.cast(fan, sensorOf(world, robot), reach, robot, hits);
  if (world.settings.realism.lasers.enabled) disturb(world, world.fleet.robots[robot], hits);
}

}  // namespace kiva
