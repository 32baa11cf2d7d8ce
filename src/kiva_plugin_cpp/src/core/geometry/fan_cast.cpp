// SPDX-License-Identifier: Apache-2.0
//
// Casts all rays of a fan at once. Instead of tracing each ray cell by cell, it determines for each
// obstacle the rays that may meet it, which are few and adjacent. Coordinates are relative to the
// laser: rays begin at (0, 0), and x is the robot's heading.
#include <algorithm>
#include <boost/container/small_vector.hpp>
#include <cmath>

#include "core/geometry/box_rays.h"
#include "core/geometry/footprint_ray.h"
#include "core/geometry/infinity.h"
#include "core/geometry/obstacles.h"

namespace kiva {
namespace {

constexpr double kAngleError = 1e-3;  // [rad] error of angleOf(), with a large margin
constexpr double kRounding = 1e-6;    // share of a position by which single precision may be off
constexpr int kFewCells = 24;
constexpr double kTouching = 1e-6;  // [m]; a laser that close to a surface may be inside it

/// Adjacent rays of a fan.
struct RayInterval {
  int first = 0, last = -1;
};

/// What rays may meet, relative to the laser, and the rays that may meet it.
struct RayTarget {
  BoxTarget box;                     // if it is another footprint, its pose
  const Footprint* other = nullptr;  // null for a box
  RayInterval rays[3];               // the whole circle, and both ends of the fan
  int parts = 0;

  FlatPose pose() const { return {box.x, box.y, box.c, box.s}; }
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

/// The directions from the laser in which a target lies [rad], counterclockwise; they may exceed
/// ±π.
struct Directions {
  double from = 0, to = 0;
  bool all = false;  ///< The target surrounds the laser.
};

Directions directionsTo(double x, double y, double radius) {
  const double square = x * x + y * y - radius * radius;
  if (square < kTouching * kTouching) return {0, 0, true};
  const double middle = angleOf(x, y), half = angleOf(std::sqrt(square), radius);
  return {middle - half, middle + half};
}

/// Returns more directions than a circle takes, which is quicker: the tangent of half its angle,
/// for the angle. `square`: of the distance along a tangent [m²], at least that of the radius.
Directions directionsAround(double x, double y, double radius, double square) {
  const double middle = angleOf(x, y), half = radius / std::sqrt(square);
  return {middle - half, middle + half};
}

/// A box lies between two of its corners, which depend on the direction of view.
Directions directionsTo(const BoxTarget& t) {
  const double px = -(t.x * t.c + t.y * t.s), py = t.x * t.s - t.y * t.c;
  const bool beside_x = std::abs(px) > t.hx + kTouching, beside_y = std::abs(py) > t.hy + kTouching;
  if (!beside_x && !beside_y) return {0, 0, true};
  const double sx = px < 0 ? -t.hx : t.hx, sy = py < 0 ? -t.hy : t.hy;
  const double ax = sx, ay = beside_x ? -sy : sy, bx = beside_y ? -sx : sx, by = sy;
  const double from_x = t.x + t.c * ax - t.s * ay, from_y = t.y + t.s * ax + t.c * ay;
  const double to_x = t.x + t.c * bx - t.s * by, to_y = t.y + t.s * bx + t.c * by;
  Directions out{angleOf(from_x, from_y), angleOf(to_x, to_y)};
  if (from_x * to_y - from_y * to_x < 0) std::swap(out.from, out.to);
  if (out.to < out.from) out.to += 2 * M_PI;
  return out;
}

/// Determines the rays that may meet a target.
void findRays(const RayFan& fan, const Directions& directions, RayTarget* target) {
  if (directions.all) {
    target->rays[target->parts++] = {0, fan.rays - 1};
    return;
  }
  const double span = fan.max_angle - fan.min_angle;
  const double per = span > 0 ? (fan.rays - 1) / span : 0;
  for (const double turn : {-2 * M_PI, 0.0, 2 * M_PI}) {
    const double begin = directions.from + turn - kAngleError;
    const double end = directions.to + turn + kAngleError;
    if (end < fan.min_angle || begin > fan.max_angle) continue;
    const double first = std::ceil((begin - fan.min_angle) * per);
    const double last = std::floor((end - fan.min_angle) * per);
    const RayInterval rays{static_cast<int>(std::max(first, 0.0)),
                           static_cast<int>(std::min(last, fan.rays - 1.0))};
    if (rays.first <= rays.last) target->rays[target->parts++] = rays;
  }
}

/// Casts rays at any footprint but a box.
void meetOther(const RayTarget& t, const Sensor& from, const RayFan& fan, const RayInterval& rays,
               FanHits* hits) {
  const Footprint& f = *t.other;
  const double radius = radiusOf(f);
  for (int k = rays.first; k <= rays.last; ++k) {
    const double c = fan.c[k], s = fan.s[k];
    const double along = t.box.x * c + t.box.y * s, across = t.box.x * s - t.box.y * c;
    RayHit hit{hits->range[k], static_cast<int>(hits->model[k])};
    if (std::abs(across) > radius || along < -radius || along - radius > hit.range) continue;
    const double met = isFixed(f)
                           ? castFootprint(f, from.x, from.y, from.z, from.c * c - from.s * s,
                                           from.s * c + from.c * s, hit.range)
                           : castFootprint(f, t.pose(), 0, 0, from.z, c, s, hit.range);
    hit.meet(met, f.model);
    hits->range[k] = hit.range;
    hits->model[k] = hit.model;
  }
}

/// The area of a fan's rays: a sector of a circle, cut off at a distance from the heading's line.
class Sector {
 public:
  Sector(const RayFan& fan, const FanReach& reach) : range_(reach.range) {
    const double widest = std::max(-fan.min_angle, fan.max_angle);
    const bool sees_behind = widest > M_PI / 2;
    back_ = sees_behind ? reach.range : 0;
    aside_ = std::min(reach.range, reach.aside);
    if (!sees_behind && widest >= 0) {
      const double widest_aside = std::max(-fan.s.front(), fan.s.back());
      aside_ = std::min(aside_, reach.range * widest_aside + kTouching);
    }
    is_convex_ = fan.max_angle - fan.min_angle <= M_PI;
    right_ = {fan.c.front(), fan.s.front()};
    left_ = {fan.c.back(), fan.s.back()};
  }

  /// Returns whether rays may meet a circle around (x, y).
  bool mayHold(double x, double y, double radius) const {
    const double most = range_ + radius + kTouching, beside = radius + kTouching;
    if (x + radius < -back_ || std::abs(y) - radius > aside_) return false;
    if (x * x + y * y > most * most) return false;
    return !is_convex_ ||
           (right_.c * y - right_.s * x >= -beside && left_.s * x - left_.c * y >= -beside);
  }

  /// Returns the box around it along the world's axes, at the laser's height.
  AxisBox boxFrom(const Sensor& from) const {
    const double middle = (range_ - back_) / 2, half = (range_ + back_) / 2;
    const double x = from.x + from.c * middle, y = from.y + from.s * middle;
    const double rounding = kTouching + kRounding * (std::abs(x) + std::abs(y));
    const double wide = std::abs(from.c) * half + std::abs(from.s) * aside_ + rounding;
    const double high = std::abs(from.s) * half + std::abs(from.c) * aside_ + rounding;
    const auto z = static_cast<float>(from.z);
    return {static_cast<float>(x - wide),
            static_cast<float>(x + wide),
            static_cast<float>(y - high),
            static_cast<float>(y + high),
            z,
            z};
  }

 private:
  struct Direction {
    double c, s;
  };
  double range_, back_, aside_;
  bool is_convex_;  // if so, it lies between its first ray's line and its last one's
  Direction right_, left_;
};

/// Returns a pose relative to the laser.
FlatPose seenFrom(const Sensor& from, double x, double y, double c, double s) {
  const double dx = x - from.x, dy = y - from.y;
  return {from.c * dx + from.s * dy, from.c * dy - from.s * dx, from.c * c + from.s * s,
          from.c * s - from.s * c};
}

/// What a fan's rays may meet.
class RayTargets {
 public:
  RayTargets(const RayFan& fan, const Sensor& from, const FanReach& reach)
      : fan_(fan), from_(from), reach_(reach), sector_(fan, reach) {}

  AxisBox area() const { return sector_.boxFrom(from_); }
  /// Returns whether rays may meet a circle around a place relative to the laser.
  bool mayMeet(const FlatPose& middle, double radius) const {
    return sector_.mayHold(middle.x, middle.y, radius);
  }

  /// Does the same for the cylinder around an entry.
  template <typename Spot>
  bool mayMeet(const Spot& spot) const {
    return spot.isAt({from_.z, from_.z}) &&
           mayMeet(seenFrom(from_, spot.x, spot.y, 1, 0), spot.radius);
  }

  /// Adds what a robot's outline hides, if rays meet it, unless the laser is near or inside: then
  /// returns false. `middle`: the robot relative to the laser; poseOf(outline): the outline.
  template <typename Outline, typename PoseOf>
  bool addAround(const FlatPose& middle, const Outline& outline, PoseOf poseOf) {
    const double radius = outline.radius;
    const double square = middle.x * middle.x + middle.y * middle.y - radius * radius;
    if (!outline.isAt(from_.z) || !(square > radius * radius)) return false;
    RayTarget& target = targets_.emplace_back();
    findRays(fan_, directionsAround(middle.x, middle.y, radius, square), &target);
    if (target.parts == 0) {
      targets_.pop_back();
      return true;
    }
    const FlatPose at = poseOf(outline);
    target.box = {at.x, at.y, at.c, at.s, outline.hx, outline.hy, outline.model};
    return true;
  }

  /// Adds a footprint that has this pose relative to the laser.
  void add(const Footprint& f, const FlatPose& pose) {
    const bool is_at_height = f.z_min <= from_.z && from_.z <= f.z_max;
    const double radius = radiusOf(f);
    if (!is_at_height || !mayMeet(pose, radius)) return;
    RayTarget& target = targets_.emplace_back();
    target.box = {pose.x, pose.y, pose.c, pose.s, f.hx, f.hy, f.model};
    if (f.kind != Footprint::Kind::kBox) target.other = &f;
    findRays(fan_, target.other ? directionsTo(pose.x, pose.y, radius) : directionsTo(target.box),
             &target);
    if (target.parts == 0) targets_.pop_back();
  }

  void cast(FanHits* hits) const {
    begin(hits);
    static const CastAtBox cast_at_box = castAtBox();
    for (const RayTarget& target : targets_) {
      for (int part = 0; part < target.parts; ++part) {
        const RayInterval& rays = target.rays[part];
        const int k = rays.first;
        if (target.other) {
          meetOther(target, from_, fan_, rays, hits);
        } else {
          cast_at_box(target.box, {&fan_.c[k], &fan_.s[k], rays.last - k + 1, &hits->range[k],
                                   &hits->model[k]});
        }
      }
    }
  }

 private:
  /// Rays that may meet targets have no hit yet, up to their reach.
  void begin(FanHits* hits) const {
    hits->first = fan_.rays;
    hits->last = -1;
    for (const RayTarget& target : targets_) {
      for (int k = 0; k < target.parts; ++k) {
        hits->first = std::min(hits->first, target.rays[k].first);
        hits->last = std::max(hits->last, target.rays[k].last);
      }
    }
    hits->range.resize(fan_.rays);
    hits->model.resize(fan_.rays);
    for (int ray = hits->first; ray <= hits->last; ++ray) {
      hits->range[ray] = std::min(reach_.range, reach_.aside * fan_.per_aside[ray]);
      hits->model[ray] = -1;
    }
  }

  const RayFan& fan_;
  const Sensor& from_;
  const FanReach& reach_;
  const Sector sector_;
  boost::container::small_vector<RayTarget, 32> targets_;
};

}  // namespace

void Obstacles::cast(const RayFan& fan, const Sensor& from, const FanReach& reach, int group,
                     FanHits* hits) const {
  RayTargets targets(fan, from, reach);
  const auto addMover = [&](int robot) {
    const double x = fleet_.x[robot], y = fleet_.y[robot];
    const FlatPose middle = seenFrom(from, x, y, 1, 0);
    if (!targets.mayMeet(middle, radius_[robot])) return;
    // Few robots have rays that meet them: only their headings are needed.
    double c = 2, s = 0;
    const auto poseOf = [&](const auto& f) {
      if (c > 1) {
        c = std::cos(fleet_.yaw[robot]);
        s = std::sin(fleet_.yaw[robot]);
      }
      return seenFrom(from, x + c * f.x - s * f.y, y + s * f.x + c * f.y, c * f.c - s * f.s,
                      s * f.c + c * f.s);
    };
    if (targets.addAround(middle, silhouettes_[robot], poseOf)) return;
    for (const Footprint& f : movers_[robot].local) targets.add(f, poseOf(f));
  };
  const auto add = [&](int handle) {
    if (handle < 0) {
      if (~handle != group) addMover(~handle);
    } else if (const Footprint& f = entries_[handle].footprint; group < 0 || f.group != group) {
      targets.add(f, seenFrom(from, f.x, f.y, f.c, f.s));
    }
  };
  const AxisBox area = targets.area();
  // The few cells of a look along the robot's lane are quicker to read than the levels of boxes.
  const CellRange cells = range({area.min_x, area.max_x, area.min_y, area.max_y});
  if ((cells.x1 - cells.x0 + 1) * (cells.y1 - cells.y0 + 1) <= kFewCells) {
    anyHandle(cells, cells, [&](int handle) {
      if (handle < 0 || targets.mayMeet(spots_[handle])) add(handle);
      return false;
    });
  } else {
    LooseGrid::Handles handles;
    boxes_.find(area, &handles);
    // Their data come from all over the memory: asked for together, they arrive together.
    for (const int handle : handles) prefetch(handle);
    for (const int handle : handles) add(handle);
  }
  targets.cast(hits);
}

void Obstacles::prefetch(int handle) const {
  if (handle >= 0) return __builtin_prefetch(&entries_[handle].footprint);
  const int robot = ~handle;
  for (const auto* column : {&fleet_.x, &fleet_.y, &fleet_.yaw}) {
    __builtin_prefetch(&(*column)[robot]);
  }
  __builtin_prefetch(&silhouettes_[robot]);
}

}  // namespace kiva
