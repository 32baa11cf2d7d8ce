// SPDX-License-Identifier: Apache-2.0
#include "world_file/mesh/extrusion.h"

#include <algorithm>
#include <cmath>

namespace kiva {
namespace {

/// Returns twice the area of a triangle, positive if a, b, c are counterclockwise.
double doubleArea(const Vector2& a, const Vector2& b, const Vector2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

bool areSame(const Vector2& a, const Vector2& b) {
  return std::abs(a.x - b.x) <= kNegligible && std::abs(a.y - b.y) <= kNegligible;
}

double doubleArea(const std::vector<Vector2>& polygon) {
  double sum = 0;
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    sum += doubleArea(polygon[0], polygon[i - 1], polygon[i]);
  }
  return sum;
}

bool isEar(const std::vector<Vector2>& at, const std::vector<int>& left, std::size_t i) {
  const std::size_t n = left.size();
  const int before = left[(i + n - 1) % n], here = left[i], after = left[(i + 1) % n];
  if (doubleArea(at[before], at[here], at[after]) <= 0) return false;
  return std::none_of(left.begin(), left.end(), [&](int other) {
    if (other == before || other == here || other == after) return false;
    return doubleArea(at[before], at[here], at[other]) >= 0 &&
           doubleArea(at[here], at[after], at[other]) >= 0 &&
           doubleArea(at[after], at[before], at[other]) >= 0;
  });
}

/// Triangulates a counterclockwise polygon by ear clipping (Meisters 1975). A polygon that crosses
/// itself may have no ear left: then any corner is clipped.
std::vector<std::array<int, 3>> triangulate(const std::vector<Vector2>& at) {
  std::vector<int> left(at.size());
  for (std::size_t i = 0; i < left.size(); ++i) left[i] = static_cast<int>(i);
  std::vector<std::array<int, 3>> triangles;
  while (left.size() > 3) {
    const std::size_t n = left.size();
    std::size_t ear = 0;
    while (ear + 1 < n && !isEar(at, left, ear)) ++ear;
    triangles.push_back({left[(ear + n - 1) % n], left[ear], left[(ear + 1) % n]});
    left.erase(left.begin() + static_cast<std::ptrdiff_t>(ear));
  }
  triangles.push_back({left[0], left[1], left[2]});
  return triangles;
}

}  // namespace

bool extrude(std::vector<Vector2> points, double height, Mesh* mesh) {
  if (points.size() > 1 && areSame(points.front(), points.back()))
    points.pop_back();  // the first point again
  if (points.size() < 3 || doubleArea(points) == 0) return false;
  if (doubleArea(points) < 0) std::reverse(points.begin(), points.end());
  const int first = static_cast<int>(mesh->vertices.size());
  const int n = static_cast<int>(points.size());
  for (const double z : {0.0, height}) {
    for (const Vector2& point : points) mesh->vertices.emplace_back(point.x, point.y, z);
  }
  for (const auto& [a, b, c] : triangulate(points)) {
    mesh->triangles.push_back({first + a, first + c, first + b});
    mesh->triangles.push_back({first + n + a, first + n + b, first + n + c});
  }
  for (int i = 0; i < n; ++i) {
    const int a = first + i, b = first + (i + 1) % n;
    mesh->triangles.push_back({a, b, b + n});
    mesh->triangles.push_back({a, b + n, a + n});
  }
  return true;
}

}  // namespace kiva
