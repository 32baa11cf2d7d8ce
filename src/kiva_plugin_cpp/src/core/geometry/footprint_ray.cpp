// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/footprint_ray.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/infinity.h"
#include "core/geometry/ray.h"
#include "core/geometry/triangle_footprint.h"

namespace kiva {
namespace {

/// Returns the distance along the ray (x, y) + t (dx, dy) to a circle, from outside or inside, or
/// +inf.
double castCircle(const FlatPose& at, double radius, double x, double y, double dx, double dy) {
  const double ox = x - at.x, oy = y - at.y;
  const double b = ox * dx + oy * dy;
  const double c = ox * ox + oy * oy - radius * radius;
  const double discriminant = b * b - c;
  if (discriminant < 0 || (c > 0 && b > 0)) return kInfinity;
  return c > 0 ? -b - std::sqrt(discriminant) : -b + std::sqrt(discriminant);
}

/// Casts by the slab test (Kay and Kajiya 1986) in the box's own axes.
double castBox(const Footprint& f, const FlatPose& at, double x, double y, double dx, double dy) {
  const double ox = x - at.x, oy = y - at.y;
  const double px = ox * at.c + oy * at.s, py = -ox * at.s + oy * at.c;
  const double vx = dx * at.c + dy * at.s, vy = -dx * at.s + dy * at.c;
  double enter = -kInfinity, leave = kInfinity;
  const double p[2] = {px, py}, v[2] = {vx, vy}, h[2] = {f.hx, f.hy};
  for (int axis = 0; axis < 2; ++axis) {
    if (v[axis] == 0) {
      if (std::abs(p[axis]) > h[axis]) return kInfinity;
      continue;
    }
    const double inverse = 1 / v[axis];
    const double t0 = (-h[axis] - p[axis]) * inverse, t1 = (h[axis] - p[axis]) * inverse;
    enter = std::max(enter, std::min(t0, t1));
    leave = std::min(leave, std::max(t0, t1));
  }
  if (enter > leave || leave < 0) return kInfinity;
  return enter >= 0 ? enter : leave;
}

double castSolid(const Footprint& f, const FlatPose& at, double x, double y, double z, double dx,
                 double dy) {
  const double ox = x - at.x, oy = y - at.y, up = z - 0.5 * (f.z_min + f.z_max);
  return f.solid->cast({ox * at.c + oy * at.s, -ox * at.s + oy * at.c, up},
                       {dx * at.c + dy * at.s, -dx * at.s + dy * at.c, 0});
}

/// Casts at a hull, which Bullet hits from outside only: from inside, the ray is cast back from its
/// far end.
double castHull(const btCollisionObject& body, const Vector3& from, const Vector3& direction,
                double range) {
  const double outside = castBody(body, from, direction, range);
  if (outside < kInfinity) return outside;
  const double back = castBody(body, from + direction * range, -direction, range);
  return back < kInfinity ? range - back : kInfinity;
}

}  // namespace

bool isFixed(const Footprint& f) {
  return f.kind == Footprint::Kind::kTriangle ||
         (f.kind == Footprint::Kind::kOther && !f.solid && f.body);
}

double castFootprint(const Footprint& f, const FlatPose& at, double x, double y, double z,
                     double dx, double dy, double range) {
  switch (f.kind) {
    case Footprint::Kind::kBox:
      return castBox(f, at, x, y, dx, dy);
    case Footprint::Kind::kCircle:
      return castCircle(at, f.hx, x, y, dx, dy);
    case Footprint::Kind::kSphere: {
      const double up = z - 0.5 * (f.z_min + f.z_max);
      return castCircle(at, std::sqrt(std::max(0.0, f.hx * f.hx - up * up)), x, y, dx, dy);
    }
    case Footprint::Kind::kTriangle:
      return castTriangle(*f.triangle, x, y, z, dx, dy);
    case Footprint::Kind::kOther:
      if (f.solid) return castSolid(f, at, x, y, z, dx, dy);
      // A model that has no body now, such as a unit with no robot near, counts as its circle.
      if (!f.body) return castCircle(at, f.hx, x, y, dx, dy);
      return castHull(*f.body, {x, y, z}, {dx, dy, 0}, range);
  }
  return kInfinity;
}

}  // namespace kiva
