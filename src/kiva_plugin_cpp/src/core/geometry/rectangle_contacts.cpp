// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/rectangle_contacts.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kiva {
namespace {

struct PlanarVector {
  double x, y;
};

/// The other rectangle in the frame of the first one.
struct View {
  double x, y;  // centre of the other [m]
  double c, s;  // cosine and sine of its heading
};

View view(const Rectangle& from, const Rectangle& to) {
  const double dx = to.x - from.x, dy = to.y - from.y;
  return {from.c * dx + from.s * dy, from.c * dy - from.s * dx, from.c * to.c + from.s * to.s,
          from.c * to.s - from.s * to.c};
}

/// The side of a rectangle that faces the other, and its distance from the other's nearest point
/// [m].
struct Face {
  double apart = -std::numeric_limits<double>::infinity();
  int axis = 0;
  double sign = 1;
};

Face nearestFace(const Rectangle& own, const Rectangle& other, const View& v) {
  const double c = std::abs(v.c), s = std::abs(v.s);
  const double along = std::abs(v.x) - own.hx - c * other.hx - s * other.hy;
  const double across = std::abs(v.y) - own.hy - s * other.hx - c * other.hy;
  if (along >= across) return {along, 0, v.x < 0 ? -1.0 : 1.0};
  return {across, 1, v.y < 0 ? -1.0 : 1.0};
}

/// A point relative to a face: distance out of it, and position along it.
struct FromFace {
  double out, along;
};

/// Returns both ends of the other's side that faces this face most.
std::array<FromFace, 2> opposingSide(const Rectangle& own, const Rectangle& other, const View& v,
                                     const Face& face) {
  const auto fromFace = [&](double x, double y) -> FromFace {
    const double at_x = v.x + v.c * x - v.s * y, at_y = v.y + v.s * x + v.c * y;
    if (face.axis == 0) return {face.sign * at_x - own.hx, at_y};
    return {face.sign * at_y - own.hy, at_x};
  };
  // The face's normal along the other's axes.
  const double nx = face.sign * (face.axis == 0 ? v.c : v.s);
  const double ny = face.sign * (face.axis == 0 ? -v.s : v.c);
  const double x = nx > 0 ? -other.hx : other.hx, y = ny > 0 ? -other.hy : other.hy;
  if (std::abs(nx) > std::abs(ny)) return {fromFace(x, -other.hy), fromFace(x, other.hy)};
  return {fromFace(-other.hx, y), fromFace(other.hx, y)};
}

/// Clips the side to the width of the face. Returns false if nothing is left.
bool clip(std::array<FromFace, 2>* side, double half) {
  auto& [p, q] = *side;
  if (p.along > q.along) std::swap(p, q);
  if (q.along < -half || p.along > half) return false;
  const double slope = q.along > p.along ? (q.out - p.out) / (q.along - p.along) : 0;
  const FromFace from = p;
  const auto cut = [&](FromFace* end, double along) {
    *end = {from.out + slope * (along - from.along), along};
  };
  if (p.along < -half) cut(&p, -half);
  if (q.along > half) cut(&q, half);
  return true;
}

PlanarVector inWorld(const Rectangle& own, double x, double y) {
  return {own.x + own.c * x - own.s * y, own.y + own.s * x + own.c * y};
}

/// Returns contacts of the face's rectangle `own`; the normal points out of the face.
OutlineContacts atFace(const Rectangle& own, const Face& face, std::array<FromFace, 2> side,
                       double reach, bool own_is_first) {
  OutlineContacts out;
  const PlanarVector normal = face.axis == 0 ? PlanarVector{face.sign * own.c, face.sign * own.s}
                                             : PlanarVector{-face.sign * own.s, face.sign * own.c};
  const double half = face.axis == 0 ? own.hx : own.hy;
  for (const FromFace& end : side) {
    if (end.out > reach) continue;
    const double outward = face.sign * (half + (own_is_first ? end.out : 0));
    const PlanarVector at =
        face.axis == 0 ? inWorld(own, outward, end.along) : inWorld(own, end.along, outward);
    const double to_first = own_is_first ? -1 : 1;
    out.at[out.count++] = {at.x, at.y, to_first * normal.x, to_first * normal.y, end.out};
  }
  return out;
}

std::array<PlanarVector, 4> corners(const Rectangle& r) {
  return {inWorld(r, r.hx, r.hy), inWorld(r, -r.hx, r.hy), inWorld(r, -r.hx, -r.hy),
          inWorld(r, r.hx, -r.hy)};
}

OutlineContacts atCorners(const Rectangle& a, const Rectangle& b, double reach) {
  OutlineContacts out;
  double least = reach;
  for (const PlanarVector& p : corners(a)) {
    for (const PlanarVector& q : corners(b)) {
      const double dx = p.x - q.x, dy = p.y - q.y, apart = std::hypot(dx, dy);
      if (apart > least || apart == 0) continue;
      least = apart;
      out.count = 1;
      out.at[0] = {q.x, q.y, dx / apart, dy / apart, apart};
    }
  }
  return out;
}

}  // namespace

bool areFarther(double distance, const Rectangle& a, const Rectangle& b) {
  return nearestFace(a, b, view(a, b)).apart > distance ||
         nearestFace(b, a, view(b, a)).apart > distance;
}

OutlineContacts findContacts(const Rectangle& a, const Rectangle& b, double reach) {
  const View from_a = view(a, b);
  const Face of_a = nearestFace(a, b, from_a);
  if (of_a.apart > reach) return {};
  const View from_b = view(b, a);
  const Face of_b = nearestFace(b, a, from_b);
  if (of_b.apart > reach) return {};
  const bool on_a = of_a.apart >= of_b.apart;
  const Rectangle& own = on_a ? a : b;
  const Face& face = on_a ? of_a : of_b;
  auto side = on_a ? opposingSide(a, b, from_a, face) : opposingSide(b, a, from_b, face);
  const bool is_faced = clip(&side, face.axis == 0 ? own.hy : own.hx);
  const OutlineContacts contacts =
      is_faced ? atFace(own, face, side, reach, on_a) : OutlineContacts();
  return contacts.count > 0 ? contacts : atCorners(a, b, reach);
}

}  // namespace kiva
