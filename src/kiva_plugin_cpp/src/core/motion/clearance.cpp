// SPDX-License-Identifier: Apache-2.0
#include "core/motion/clearance.h"

#include <algorithm>
#include <cmath>

namespace kiva {
namespace {

constexpr double kPushed = 0.5;  // [m/s] by which a robot in Bullet may be faster than it drives
constexpr double kStill = 1e-9;  // [m/s, rad/s]

bool standsStill(const Fleet& f, int i) {
  if (!f.awake[i]) return true;
  if (f.activated[i] || std::abs(f.vx[i]) > kStill || std::abs(f.vy[i]) > kStill ||
      std::abs(f.yaw_rate[i]) > kStill) {
    return false;
  }
  if (f.robots[i].segments.empty()) return true;
  const MotionSegment::Kind kind = f.robots[i].segments.front().kind;
  return kind == MotionSegment::Kind::kRaise || kind == MotionSegment::Kind::kLower;
}

/// Its circle stays where it is until it begins another segment, and then it looks around itself.
bool turnsInPlace(const Fleet& f, int i) {
  return !f.activated[i] && !f.robots[i].segments.empty() &&
         f.robots[i].segments.front().kind == MotionSegment::Kind::kTurn &&
         std::abs(f.vx[i]) < kStill && std::abs(f.vy[i]) < kStill;
}

/// How fast its circle may come nearer [m/s].
double approachSpeed(const Fleet& f, int i) {
  if (turnsInPlace(f, i)) return 0;
  const double speed = f.robots[i].drive.speed;
  return f.activated[i] ? std::max(speed, std::hypot(f.vx[i], f.vy[i]) + kPushed) : speed;
}

Footprint circleOf(const Fleet& f, int i, double radius) {
  Footprint circle;
  circle.kind = Footprint::Kind::kCircle;
  circle.x = f.x[i];
  circle.y = f.y[i];
  circle.hx = radius;
  return circle;
}

}  // namespace

Footprint footprintOf(const Fleet& f, int i) {
  const Robot& r = f.robots[i];
  Footprint own;
  own.x = f.x[i];
  own.y = f.y[i];
  own.c = std::cos(f.yaw[i]);
  own.s = std::sin(f.yaw[i]);
  own.hx = std::max(r.half_length, r.load_half_length);
  own.hy = std::max(r.half_width, r.load_half_width);
  own.z_max = f.unit[i] < 0 ? r.height + f.tower[i] : 1e9;
  return own;
}

Footprint turned(Footprint geometry) {
  geometry.kind = Footprint::Kind::kCircle;
  geometry.hx = std::hypot(geometry.hx, geometry.hy);
  return geometry;
}

Footprint moved(Footprint geometry, double dx, double dy) {
  geometry.x += dx / 2;
  geometry.y += dy / 2;
  geometry.hx += std::hypot(dx, dy) / 2;
  return geometry;
}

bool isClear(const WorldState& world, int robot, const Footprint& swept, double time) {
  const Fleet& f = world.fleet;
  const double z = world.floor.z;  // a swept footprint counts from there
  const auto meets = [&](const Footprint& other) {
    return other.z_min - z <= swept.z_max && other.z_max - z >= swept.z_min &&
           mayBeWithin(kNear, swept, other) && gap(swept, other) < kNear;
  };
  const auto approaches = [&](int i, double radius) {
    if (i == robot) return false;
    const double reach = kNear + (standsStill(f, i) ? 0 : approachSpeed(f, i)) * time;
    if (gap(swept, circleOf(f, i, radius)) >= reach) return false;
    if (!standsStill(f, i)) return true;
    const auto& footprints = world.obstacles.footprints(i);
    return std::any_of(footprints.begin(), footprints.end(), meets);
  };
  const double farthest = (world.top_speed + kPushed) * time + kNear;
  return !world.obstacles.any(swept.x, swept.y, radiusOf(swept) + farthest, meets, approaches);
}

}  // namespace kiva
