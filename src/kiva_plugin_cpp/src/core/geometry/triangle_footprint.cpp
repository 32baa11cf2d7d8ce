// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/triangle_footprint.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/infinity.h"

namespace kiva {
namespace {

struct Interval {
  double min = kInfinity, max = -kInfinity;
  void add(double value) {
    min = std::min(min, value);
    max = std::max(max, value);
  }
};

double gap(const Interval& a, const Interval& b) { return std::max(a.min - b.max, b.min - a.max); }

Interval project(const Triangle& triangle, double nx, double ny) {
  Interval out;
  for (const Vector3& corner : triangle) out.add(corner.X() * nx + corner.Y() * ny);
  return out;
}

Interval project(const Footprint& f, double nx, double ny) {
  const double centre = f.x * nx + f.y * ny;
  const double half = f.kind == Footprint::Kind::kBox ? std::abs(f.c * nx + f.s * ny) * f.hx +
                                                            std::abs(f.c * ny - f.s * nx) * f.hy
                                                      : f.hx;
  return {centre - half, centre + half};
}

/// Returns the gap along an axis of any length; -inf for length 0.
double gapAlong(const Triangle& triangle, const Footprint& other, double nx, double ny) {
  const double length = std::hypot(nx, ny);
  if (length < 1e-12) return -kInfinity;
  nx /= length;
  ny /= length;
  return gap(project(triangle, nx, ny), project(other, nx, ny));
}

struct CutEnd {
  double x = 0, y = 0;
};

/// Computes the line in which the triangle is cut at height z. Returns false if it is not cut.
bool slice(const Triangle& triangle, double z, CutEnd* from, CutEnd* to) {
  CutEnd* const ends[] = {from, to};
  int count = 0;
  for (int i = 0; i < 3 && count < 2; ++i) {
    const Vector3& a = triangle[i];
    const Vector3& b = triangle[(i + 1) % 3];
    if ((a.Z() >= z) == (b.Z() >= z)) continue;
    const double share = (z - a.Z()) / (b.Z() - a.Z());
    *ends[count++] = {a.X() + share * (b.X() - a.X()), a.Y() + share * (b.Y() - a.Y())};
  }
  return count == 2;
}

}  // namespace

Triangle cornersOf(const Mesh& mesh, int triangle, const Pose& pose) {
  Triangle out;
  for (int i = 0; i < 3; ++i) {
    out[i] = pose.CoordPositionAdd(mesh.vertices[mesh.triangles[triangle][i]]);
  }
  return out;
}

Footprint makeFootprint(const Triangle& triangle) {
  Interval x, y, z;
  for (const Vector3& corner : triangle) {
    x.add(corner.X());
    y.add(corner.Y());
    z.add(corner.Z());
  }
  Footprint out;
  out.kind = Footprint::Kind::kTriangle;
  out.x = (x.min + x.max) / 2;
  out.y = (y.min + y.max) / 2;
  out.hx = (x.max - x.min) / 2;
  out.hy = (y.max - y.min) / 2;
  out.z_min = z.min;
  out.z_max = z.max;
  out.triangle = &triangle;
  return out;
}

double castTriangle(const Triangle& triangle, double x, double y, double z, double dx, double dy) {
  CutEnd a, b;
  if (!slice(triangle, z, &a, &b)) return kInfinity;
  const double ex = b.x - a.x, ey = b.y - a.y;
  const double across = dx * ey - dy * ex;
  if (across == 0) return kInfinity;
  const double ax = a.x - x, ay = a.y - y;
  const double along_edge = (ax * dy - ay * dx) / across;
  const double range = (ax * ey - ay * ex) / across;
  return along_edge >= 0 && along_edge <= 1 && range >= 0 ? range : kInfinity;
}

double gapToTriangle(const Triangle& triangle, const Footprint& other) {
  double widest = -kInfinity;
  const auto test = [&](double nx, double ny) {
    widest = std::max(widest, gapAlong(triangle, other, nx, ny));
  };
  for (int i = 0; i < 3; ++i) {
    const Vector3& a = triangle[i];
    const Vector3 edge = triangle[(i + 1) % 3] - a;
    test(-edge.Y(), edge.X());
    test(edge.X(), edge.Y());  // from above, a vertical triangle is a line with two ends
    if (other.kind != Footprint::Kind::kBox) test(other.x - a.X(), other.y - a.Y());
  }
  if (other.kind == Footprint::Kind::kBox) {
    test(other.c, other.s);
    test(-other.s, other.c);
  }
  return widest;
}

}  // namespace kiva
