// SPDX-License-Identifier: Apache-2.0
#include "sensing.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kiva {
namespace {

// What the corridor is wider than the robot, a side. A loaded robot that turns in the next lane
// reaches to 1 − 0.566 m, which must stay outside.
constexpr double kSideMargin = 0.03;  // [m]

struct Sensor {
  double x, y, z, yaw;
};

Sensor sensorOf(const Parts& parts, int robot) {
  const Fleet& f = parts.fleet;
  const LaserParameters& laser = f.robots[robot].laser;
  const double c = std::cos(f.yaw[robot]), s = std::sin(f.yaw[robot]);
  return {f.x[robot] + c * laser.x, f.y[robot] + s * laser.x, laser.z, f.yaw[robot]};
}

double rayAngle(const LaserParameters& laser, int ray) {
  const double span = laser.max_angle - laser.min_angle;
  return laser.min_angle + (laser.rays > 1 ? span * ray / (laser.rays - 1) : 0);
}

}  // namespace

void castScan(const Parts& parts, int robot, std::vector<RayHit>* hits) {
  const LaserParameters& laser = parts.fleet.robots[robot].laser;
  const Sensor sensor = sensorOf(parts, robot);
  hits->resize(laser.rays);
  for (int ray = 0; ray < laser.rays; ++ray) {
    const double angle = sensor.yaw + rayAngle(laser, ray);
    (*hits)[ray] = parts.obstacles.cast(sensor.x, sensor.y, sensor.z, std::cos(angle),
                                        std::sin(angle), laser.max_range, robot);
  }
}

bool blocks(const Parts& parts, int robot, int model) {
  const Model& other = *parts.models[model];
  if (other.kind != ModelKind::kStorageUnit) return true;
  return parts.fleet.unit[robot] >= 0 || parts.units[other.index].carrier >= 0;
}

Ahead lookAhead(const Parts& parts, int robot) {
  const Robot& r = parts.fleet.robots[robot];
  const double half = std::max(r.half_width, r.load_half_width) + kSideMargin;
  static thread_local std::vector<RayHit> hits;
  castScan(parts, robot, &hits);
  Ahead ahead{std::numeric_limits<double>::infinity(), -1};
  for (int ray = 0; ray < r.laser.rays; ++ray) {
    const RayHit& hit = hits[ray];
    if (hit.model < 0 || !blocks(parts, robot, hit.model)) continue;
    const double angle = rayAngle(r.laser, ray);
    if (std::abs(hit.range * std::sin(angle)) > half) continue;
    const double distance = r.laser.x + hit.range * std::cos(angle);
    if (distance < ahead.distance) ahead = {distance, hit.model};
  }
  return ahead;
}

bool isFree(const Parts& parts, int robot, double x, double y) {
  const Robot& r = parts.fleet.robots[robot];
  Footprint disc;
  disc.kind = Footprint::Kind::kCircle;
  disc.x = x;
  disc.y = y;
  disc.hx = std::hypot(std::max(r.half_length, r.load_half_length),
                       std::max(r.half_width, r.load_half_width));
  bool is_free = true;
  parts.obstacles.near(x, y, disc.hx, [&](const Footprint& other) {
    if (!is_free || other.group == robot || gap(disc, other) > 0) return;
    is_free = !blocks(parts, robot, other.model);
  });
  return is_free;
}

}  // namespace kiva
