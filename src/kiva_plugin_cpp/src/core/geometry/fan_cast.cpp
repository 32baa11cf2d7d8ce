// SPDX-License-Identifier: Apache-2.0
//
// Casts all rays of a fan at once. Instead of tracing each ray cell by cell, it determines for each
// obstacle the rays that may meet it, which are few and adjacent. Coordinates are relative to the
// laser: rays begin at (0, 0), and x is the robot's heading.
#include <algorithm>
#include <boost/container/small_vector.hpp>
#include <cmath>

#include "core/geometry/footprint_ray.h"
#include "core/geometry/infinity.h"
#include "core/geometry/obstacles.h"

namespace kiva {
namespace {

constexpr double kAngleError = 1e-3;  // [rad] error of angleOf(), with a large margin
constexpr double kTouching = 1e-6;    // [m]; a laser that close to a surface may be inside it

/// Adjacent rays of a fan.
struct RayInterval {
  int first = 0, last = -1;
};

/// A footprint relative to the laser, and the rays that may meet it.
struct RayTarget : FlatPose {
  const Footprint* shape = nullptr;
  RayInterval rays[3];  // the whole circle, and both ends of the fan
  int parts = 0;
};

/// Returns the angle of a direction [rad], within kAngleError.
double angleOf(double x, double y) {
  const double ax = std::abs(x), ay = std::abs(y);
  const double a = std::min(ax, ay) / std::max({ax, ay, 1e-300}), s = a * a;
  double angle = ((-0.0464964749 * s + 0.15931422) * s - 0.327622764) * s * a + a;
  if (ay > ax) angle = M_PI / 2 - angle;
  if (x < 0) angle = M_PI - angle;
  return y < 0 ? -angle : angle;
}

/// Returns the directions from the laser in which a target lies, counterclockwise; they may exceed
/// ±π. Returns false if the target surrounds the laser.
bool anglesTo(const RayTarget& t, double* from, double* to) {
  const Footprint& f = *t.shape;
  if (f.kind != Footprint::Kind::kBox) {
    const double radius = radiusOf(f), square = t.x * t.x + t.y * t.y - radius * radius;
    if (square < kTouching * kTouching) return false;
    const double middle = angleOf(t.x, t.y), half = angleOf(std::sqrt(square), radius);
    *from = middle - half;
    *to = middle + half;
    return true;
  }
  // The target lies between two of its corners, which depend on the direction of view.
  const double px = -(t.x * t.c + t.y * t.s), py = t.x * t.s - t.y * t.c;
  const bool beside_x = std::abs(px) > f.hx + kTouching, beside_y = std::abs(py) > f.hy + kTouching;
  if (!beside_x && !beside_y) return false;
  const double sx = px < 0 ? -f.hx : f.hx, sy = py < 0 ? -f.hy : f.hy;
  const double ax = sx, ay = beside_x ? -sy : sy, bx = beside_y ? -sx : sx, by = sy;
  const double from_x = t.x + t.c * ax - t.s * ay, from_y = t.y + t.s * ax + t.c * ay;
  const double to_x = t.x + t.c * bx - t.s * by, to_y = t.y + t.s * bx + t.c * by;
  *from = angleOf(from_x, from_y);
  *to = angleOf(to_x, to_y);
  if (from_x * to_y - from_y * to_x < 0) std::swap(*from, *to);
  if (*to < *from) *to += 2 * M_PI;
  return true;
}

/// Determines the rays between two angles [rad], which may exceed ±π.
void findRays(const RayFan& fan, double from, double to, RayTarget* target) {
  const double span = fan.max_angle - fan.min_angle;
  const double per = span > 0 ? (fan.rays - 1) / span : 0;
  for (const double turn : {-2 * M_PI, 0.0, 2 * M_PI}) {
    const double first = std::ceil((from + turn - kAngleError - fan.min_angle) * per);
    const double last = std::floor((to + turn + kAngleError - fan.min_angle) * per);
    const RayInterval rays{static_cast<int>(std::max(first, 0.0)),
                           static_cast<int>(std::min(last, fan.rays - 1.0))};
    if (rays.first <= rays.last) target->rays[target->parts++] = rays;
  }
}

void findRays(const RayFan& fan, RayTarget* target) {
  double from = 0, to = 0;
  if (anglesTo(*target, &from, &to)) return findRays(fan, from, to, target);
  target->rays[target->parts++] = {0, fan.rays - 1};
}

/// Casts rays by the slab test (Kay and Kajiya 1986) in the box's own axes, several at a time.
__attribute__((target_clones("avx2", "default"))) void meetBox(const RayTarget& t, const double* c,
                                                               const double* s, int rays,
                                                               double* range, std::int64_t* model) {
  const double tc = t.c, ts = t.s, hx = t.shape->hx, hy = t.shape->hy;
  const double px = -(t.x * tc + t.y * ts), py = t.x * ts - t.y * tc;
  const std::int64_t own = t.shape->model;
#pragma GCC ivdep
  for (int k = 0; k < rays; ++k) {
    const double vx = c[k] * tc + s[k] * ts, vy = s[k] * tc - c[k] * ts;
    const double ix = 1 / (vx == 0 ? 1e-300 : vx), iy = 1 / (vy == 0 ? 1e-300 : vy);
    const double x0 = (-hx - px) * ix, x1 = (hx - px) * ix;
    const double y0 = (-hy - py) * iy, y1 = (hy - py) * iy;
    const double in_x = x0 < x1 ? x0 : x1, out_x = x0 < x1 ? x1 : x0;
    const double in_y = y0 < y1 ? y0 : y1, out_y = y0 < y1 ? y1 : y0;
    const double enter = in_x > in_y ? in_x : in_y, leave = out_x < out_y ? out_x : out_y;
    const double met = enter >= 0 ? enter : leave;
    const bool is_met = (enter <= leave) & (leave >= 0);
    const bool is_first = (met < range[k]) | ((met == range[k]) & (own < model[k]));
    const bool counts = is_met & is_first;
    range[k] = counts ? met : range[k];
    model[k] = counts ? own : model[k];
  }
}

/// Does the same for any other footprint.
void meetOther(const RayTarget& t, const Sensor& from, const RayFan& fan, const RayInterval& rays,
               FanHits* hits) {
  const Footprint& f = *t.shape;
  const double radius = radiusOf(f);
  for (int k = rays.first; k <= rays.last; ++k) {
    const double c = fan.c[k], s = fan.s[k];
    const double along = t.x * c + t.y * s, across = t.x * s - t.y * c;
    RayHit hit{hits->range[k], static_cast<int>(hits->model[k])};
    if (std::abs(across) > radius || along < -radius || along - radius > hit.range) continue;
    const double met = isFixed(f)
                           ? castFootprint(f, from.x, from.y, from.z, from.c * c - from.s * s,
                                           from.s * c + from.c * s, hit.range)
                           : castFootprint(f, t, 0, 0, from.z, c, s, hit.range);
    hit.meet(met, f.model);
    hits->range[k] = hit.range;
    hits->model[k] = hit.model;
  }
}

void meet(const RayTarget& target, const Sensor& from, const RayFan& fan, const RayInterval& rays,
          FanHits* hits) {
  if (target.shape->kind != Footprint::Kind::kBox) {
    return meetOther(target, from, fan, rays, hits);
  }
  const int k = rays.first;
  meetBox(target, &fan.c[k], &fan.s[k], rays.last - k + 1, &hits->range[k], &hits->model[k]);
}

/// The area of a fan's rays, as a box along the heading [m].
struct Sector {
  double back, ahead, aside;

  Sector(const RayFan& fan, const FanReach& reach) {
    const bool sees_behind = std::max(-fan.min_angle, fan.max_angle) > M_PI / 2;
    back = sees_behind ? reach.range : 0;
    ahead = reach.range;
    aside = std::min(reach.range, reach.aside);
  }
  /// Returns whether rays may meet a circle around (x, y).
  bool mayHold(double x, double y, double radius) const {
    return x + radius >= -back && x - radius <= ahead && std::abs(y) - radius <= aside;
  }
};

/// Returns a pose relative to the laser.
FlatPose seenFrom(const Sensor& from, double x, double y, double c, double s) {
  const double dx = x - from.x, dy = y - from.y;
  return {from.c * dx + from.s * dy, from.c * dy - from.s * dx, from.c * c + from.s * s,
          from.c * s - from.s * c};
}

/// Casts the rays that may meet targets up to their reach, or up to the nearest hit so far.
template <typename Targets>
void begin(const RayFan& fan, const FanReach& reach, const Targets& targets, FanHits* hits) {
  hits->first = fan.rays;
  hits->last = -1;
  for (const RayTarget& target : targets) {
    for (int k = 0; k < target.parts; ++k) {
      hits->first = std::min(hits->first, target.rays[k].first);
      hits->last = std::max(hits->last, target.rays[k].last);
    }
  }
  hits->range.resize(fan.rays);
  hits->model.resize(fan.rays);
  for (int ray = hits->first; ray <= hits->last; ++ray) {
    hits->range[ray] = std::min(reach.range, reach.aside * fan.per_aside[ray]);
    hits->model[ray] = -1;
  }
}

}  // namespace

void Obstacles::cast(const RayFan& fan, const Sensor& from, const FanReach& reach, int group,
                     FanHits* hits) const {
  const Sector sector(fan, reach);
  boost::container::small_vector<RayTarget, 32> targets;
  const auto isAtHeight = [&](const Footprint& f) {
    return f.z_min <= from.z && from.z <= f.z_max;
  };
  const auto add = [&](const Footprint& f, const FlatPose& pose) {
    if (!sector.mayHold(pose.x, pose.y, radiusOf(f))) return;
    RayTarget target;
    static_cast<FlatPose&>(target) = pose;
    target.shape = &f;
    findRays(fan, &target);
    if (target.parts > 0) targets.push_back(target);
  };
  const auto addMover = [&](int robot) {
    const double x = fleet_.x[robot], y = fleet_.y[robot];
    const FlatPose middle = seenFrom(from, x, y, 1, 0);
    if (!sector.mayHold(middle.x, middle.y, radius_[robot])) return;
    const double c = std::cos(fleet_.yaw[robot]), s = std::sin(fleet_.yaw[robot]);
    for (const Footprint& f : movers_[robot].local) {
      if (!isAtHeight(f)) continue;
      add(f, seenFrom(from, x + c * f.x - s * f.y, y + s * f.x + c * f.y, c * f.c - s * f.s,
                      s * f.c + c * f.s));
    }
  };
  // The area along the world's axes.
  const double middle = (sector.ahead - sector.back) / 2, half = (sector.ahead + sector.back) / 2;
  const double x = from.x + from.c * middle, y = from.y + from.s * middle;
  const double wide = std::abs(from.c) * half + std::abs(from.s) * sector.aside;
  const double high = std::abs(from.s) * half + std::abs(from.c) * sector.aside;
  const CellRange cells = range({x - wide, x + wide, y - high, y + high});
  anyHandle(cells, cells, [&](int handle) {
    if (handle < 0) {
      if (~handle != group) addMover(~handle);
    } else if (const Footprint& f = entries_[handle].footprint;
               isAtHeight(f) && (group < 0 || f.group != group)) {
      add(f, seenFrom(from, f.x, f.y, f.c, f.s));
    }
    return false;
  });
  begin(fan, reach, targets, hits);
  for (const RayTarget& target : targets) {
    for (int k = 0; k < target.parts; ++k) meet(target, from, fan, target.rays[k], hits);
  }
}

}  // namespace kiva
