// SPDX-License-Identifier: Apache-2.0
#include "outline.h"

#include <algorithm>
#include <cmath>

namespace kiva {
namespace {

constexpr double kHigh = 2.5;        // [m]: a robot with a load passes beneath
constexpr double kFinest = 0.02;     // [m]
constexpr int kMostCells = 128;      // along the longer side
constexpr double kSameHeight = 0.1;  // [m]

using Corners = std::array<Vector3, 3>;

/// Returns whether a triangle, seen from above, reaches into the square around (x, y).
bool reachesInto(const Corners& t, double x, double y, double half) {
  for (int i = 0; i < 3; ++i) {
    const Vector3& a = t[i];
    const Vector3 edge = t[(i + 1) % 3] - a;
    double least = 1e300, most = -1e300;
    for (const Vector3& corner : t) {
      const double side = edge.X() * (corner.Y() - a.Y()) - edge.Y() * (corner.X() - a.X());
      least = std::min(least, side);
      most = std::max(most, side);
    }
    const double middle = edge.X() * (y - a.Y()) - edge.Y() * (x - a.X());
    const double reach = half * (std::abs(edge.X()) + std::abs(edge.Y()));
    if (middle - reach > most || middle + reach < least) return false;
  }
  return true;
}

/// Heights over the cells of a grid.
class Columns {
 public:
  explicit Columns(const std::vector<Corners>& triangles) {
    Vector3 low = triangles.front()[0], high = low;
    for (const Corners& t : triangles) {
      for (const Vector3& corner : t) {
        low.Min(corner);
        high.Max(corner);
      }
    }
    const double longest = std::max(high.X() - low.X(), high.Y() - low.Y());
    edge_ = std::max(kFinest, longest / kMostCells);
    x_ = low.X();
    y_ = low.Y();
    columns_ = static_cast<int>(std::floor((high.X() - low.X()) / edge_)) + 1;
    rows_ = static_cast<int>(std::floor((high.Y() - low.Y()) / edge_)) + 1;
    cells_.resize(static_cast<std::size_t>(columns_) * rows_);
    for (const Corners& t : triangles) add(t);
  }

  /// Returns rectangles of equal heights, each as large as its first row permits.
  std::vector<OutlineBox> boxes() {
    std::vector<OutlineBox> out;
    for (int row = 0; row < rows_; ++row) {
      for (int column = 0; column < columns_; ++column) {
        if (at(row, column).is_used || at(row, column).is_empty()) continue;
        out.push_back(take(row, column));
      }
    }
    return out;
  }

 private:
  struct Cell {
    double low = 1e300, high = -1e300;
    bool is_used = false;
    bool is_empty() const { return low > high; }
    bool isLike(const Cell& o) const {
      return !is_used && !is_empty() && std::abs(low - o.low) < kSameHeight &&
             std::abs(high - o.high) < kSameHeight;
    }
  };

  Cell& at(int row, int column) {
    return cells_[static_cast<std::size_t>(row) * columns_ + column];
  }

  int index(double from, double first, int count) const {
    return std::clamp(static_cast<int>(std::floor((from - first) / edge_)), 0, count - 1);
  }

  void add(const Corners& t) {
    const auto [left, right] = std::minmax({t[0].X(), t[1].X(), t[2].X()});
    const auto [front, back] = std::minmax({t[0].Y(), t[1].Y(), t[2].Y()});
    const auto [low, high] = std::minmax({t[0].Z(), t[1].Z(), t[2].Z()});
    for (int row = index(front, y_, rows_); row <= index(back, y_, rows_); ++row) {
      for (int column = index(left, x_, columns_); column <= index(right, x_, columns_); ++column) {
        const double x = x_ + (column + 0.5) * edge_, y = y_ + (row + 0.5) * edge_;
        if (!reachesInto(t, x, y, edge_ / 2)) continue;
        at(row, column).low = std::min(at(row, column).low, low);
        at(row, column).high = std::max(at(row, column).high, high);
      }
    }
  }

  OutlineBox take(int row, int column) {
    const Cell first = at(row, column);
    int right = column, top = row;
    while (right + 1 < columns_ && at(row, right + 1).isLike(first)) ++right;
    const auto isRowLike = [&](int other) {
      for (int i = column; i <= right; ++i) {
        if (!at(other, i).isLike(first)) return false;
      }
      return true;
    };
    while (top + 1 < rows_ && isRowLike(top + 1)) ++top;
    for (int i = row; i <= top; ++i) {
      for (int k = column; k <= right; ++k) at(i, k).is_used = true;
    }
    const Vector3 low(x_ + column * edge_, y_ + row * edge_, first.low);
    const Vector3 high(x_ + (right + 1) * edge_, y_ + (top + 1) * edge_, first.high);
    return {(low + high) * 0.5, high - low};
  }

  double edge_ = 0, x_ = 0, y_ = 0;
  int columns_ = 0, rows_ = 0;
  std::vector<Cell> cells_;
};

}  // namespace

std::vector<OutlineBox> outlineOf(const Mesh& mesh, const Pose& pose) {
  std::vector<Corners> all, low;
  for (const auto& triangle : mesh.triangles) {
    Corners corners;
    for (int i = 0; i < 3; ++i) corners[i] = pose.CoordPositionAdd(mesh.vertices[triangle[i]]);
    all.push_back(corners);
    if (std::min({corners[0].Z(), corners[1].Z(), corners[2].Z()}) < kHigh) low.push_back(corners);
  }
  if (all.empty()) return {};
  return Columns(low.empty() ? all : low).boxes();
}

}  // namespace kiva
