// SPDX-License-Identifier: Apache-2.0
#include "core/sensing/sensing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kiva {
namespace {

// What the corridor is wider than the robot, a side. A loaded robot that turns in the next lane
// reaches to 1 − 0.566 m, which must stay outside.
constexpr double kSideMargin = 0.03;  // [m]
constexpr int kMostTogether = 16;
constexpr double kFlat = 0.02;  // [m] by which two rays beside each other differ on a face

struct Sensor {
  double x, y, z;
  double c, s;  // of its heading
};

Sensor sensorOf(const WorldState& world, int robot) {
  const Fleet& f = world.fleet;
  const LaserParameters& laser = f.robots[robot].laser;
  const double c = std::cos(f.yaw[robot]), s = std::sin(f.yaw[robot]);
  return {f.x[robot] + c * laser.x, f.y[robot] + s * laser.x, world.floor.z + laser.z, c, s};
}

double rayAngle(const LaserParameters& laser, int ray) {
  const double span = laser.max_angle - laser.min_angle;
  return laser.min_angle + (laser.rays > 1 ? span * ray / (laser.rays - 1) : 0);
}

/// How many robots with successive ids scan in the same step, where more than one has to: they
/// mostly stand side by side and see the same, which then is in the processor's cache. A power of
/// two, so that it seldom changes as robots come and go, and with it when a robot scans.
int scanTogether(int robots, std::uint64_t period) {
  int together = 1;
  while (together < kMostTogether && 2 * together * period <= static_cast<std::uint64_t>(robots)) {
    together *= 2;
  }
  return together;
}

/// Rebuilds the rounds after robots have come or gone.
void arrangeScans(WorldState& world) {
  world.scan_rounds.clear();
  world.scan_rounds_revision = world.models_revision;
  for (int i = 0; i < world.fleet.size(); ++i) {
    const Robot& robot = world.fleet.robots[i];
    if (!robot.laser.fitted) continue;
    const std::uint64_t period = scanPeriod(world, robot);
    auto round = std::find_if(world.scan_rounds.begin(), world.scan_rounds.end(),
                              [&](const ScanRound& r) { return r.period == period; });
    if (round == world.scan_rounds.end()) {
      round = world.scan_rounds.insert(round, {period, {}});
      round->robots_at.resize(period);
    }
    // Weyl's sequence by the golden ratio spreads any set of ids evenly.
    const int group = robot.id / scanTogether(world.fleet.size(), period);
    const double spread = std::fmod(group * 0.6180339887498949, 1.0);
    const auto offset = static_cast<std::uint64_t>(spread * static_cast<double>(period));
    round->robots_at[(period - offset) % period].push_back(i);
  }
}

/// Casts each ray as far as limit(ray) [m].
template <typename Limit>
void castRays(const WorldState& world, int robot, Limit limit, std::vector<RayHit>* hits) {
  const LaserParameters& laser = world.fleet.robots[robot].laser;
  const RayFan& fan = world.ray_fans[world.fleet.robots[robot].ray_fan];
  const Sensor at = sensorOf(world, robot);
  hits->resize(laser.rays);
  for (int ray = 0; ray < laser.rays; ++ray) {
    const double dx = at.c * fan.c[ray] - at.s * fan.s[ray];
    const double dy = at.s * fan.c[ray] + at.c * fan.s[ray];
    (*hits)[ray] = world.obstacles.cast(at.x, at.y, at.z, dx, dy, limit(ray), robot);
  }
}

}  // namespace

std::uint64_t scanPeriod(const WorldState& world, const Robot& robot) {
  return std::max<std::uint64_t>(1, std::llround(1 / (robot.laser.rate * world.dt)));
}

void findDueScans(WorldState& world) {
  if (world.scan_rounds_revision != world.models_revision) arrangeScans(world);
  world.scans_due.clear();
  for (const ScanRound& round : world.scan_rounds) {
    const std::vector<int>& due = round.robots_at[world.total_steps % round.period];
    world.scans_due.insert(world.scans_due.end(), due.begin(), due.end());
  }
  if (world.scan_rounds.size() > 1) std::sort(world.scans_due.begin(), world.scans_due.end());
}

void setRays(WorldState& world, Robot* robot) {
  const LaserParameters& laser = robot->laser;
  const auto same = [&](const RayFan& fan) {
    return fan.rays == laser.rays && fan.min_angle == laser.min_angle &&
           fan.max_angle == laser.max_angle;
  };
  const auto at = std::find_if(world.ray_fans.begin(), world.ray_fans.end(), same);
  robot->ray_fan = static_cast<int>(at - world.ray_fans.begin());
  if (at != world.ray_fans.end()) return;
  RayFan fan{laser.rays, laser.min_angle, laser.max_angle, {}, {}};
  for (int ray = 0; ray < laser.rays; ++ray) {
    fan.c.push_back(std::cos(rayAngle(laser, ray)));
    fan.s.push_back(std::sin(rayAngle(laser, ray)));
  }
  world.ray_fans.push_back(std::move(fan));
}

void castScan(const WorldState& world, int robot, std::vector<RayHit>* hits) {
  const double range = world.fleet.robots[robot].laser.max_range;
  castRays(
      world, robot, [range](int) { return range; }, hits);
}

bool blocks(const WorldState& world, int robot, int model) {
  const Model& other = *world.models[model];
  if (other.kind != ModelKind::kStorageUnit) return true;
  return world.fleet.unit[robot] >= 0 || world.units[other.index].carrier >= 0;
}

Ahead lookAhead(const WorldState& world, int robot) {
  const Robot& r = world.fleet.robots[robot];
  const RayFan& fan = world.ray_fans[r.ray_fan];
  const double half = std::max(r.half_width, r.load_half_width) + kSideMargin;
  static thread_local std::vector<RayHit> hits;
  // A ray is of interest until it leaves the corridor.
  const auto limit = [&](int ray) {
    return std::min(r.laser.max_range, half / std::max(1e-9, std::abs(fan.s[ray])));
  };
  castRays(world, robot, limit, &hits);
  Ahead ahead{std::numeric_limits<double>::infinity()};
  int before = -1;  // what the ray before this one met
  double before_distance = 0;
  for (int ray = 0; ray < r.laser.rays; ++ray) {
    const RayHit& hit = hits[ray];
    const int model = hit.model >= 0 && blocks(world, robot, hit.model) ? hit.model : -1;
    const double distance = r.laser.x + hit.range * fan.c[ray];
    const bool faces = model == before && std::abs(distance - before_distance) < kFlat;
    if (model >= 0 && distance < ahead.distance) {
      ahead = {distance, model, faces};
    } else if (faces && before_distance == ahead.distance) {
      ahead.faces = true;
    }
    before = model;
    before_distance = distance;
  }
  return ahead;
}

bool isFree(const WorldState& world, int robot, double x, double y) {
  const Robot& r = world.fleet.robots[robot];
  Footprint disc;
  disc.kind = Footprint::Kind::kCircle;
  disc.x = x;
  disc.y = y;
  disc.hx = std::hypot(std::max(r.half_length, r.load_half_length),
                       std::max(r.half_width, r.load_half_width));
  bool is_free = true;
  world.obstacles.near(x, y, disc.hx, [&](const Footprint& other) {
    if (!is_free || other.group == robot || gap(disc, other) > 0) return;
    is_free = !blocks(world, robot, other.model);
  });
  return is_free;
}

}  // namespace kiva
