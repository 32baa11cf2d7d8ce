// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/obstacles.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/geometry/footprint_ray.h"
#include "core/geometry/infinity.h"
#include "core/geometry/triangle_footprint.h"

namespace kiva {
namespace {

constexpr double kCell = 1.0;           // [m]
constexpr int kMaxCells = 2048;         // a side; entries farther out are not indexed by cell
constexpr long kMostCellsEach = 16384;  // larger entries are checked by every query
// Error of a position and a radius in single precision: an absolute part, and a share of their
// size.
constexpr double kSpotMargin = 0.001;  // [m]
constexpr double kFloatMargin = 2.4e-7;
constexpr double kHidden = 0.001;  // least depth of what a box hides [m]

double halfX(const Footprint& f) {
  return f.kind == Footprint::Kind::kBox ? std::abs(f.c) * f.hx + std::abs(f.s) * f.hy : f.hx;
}
double halfY(const Footprint& f) {
  return f.kind == Footprint::Kind::kBox        ? std::abs(f.s) * f.hx + std::abs(f.c) * f.hy
         : f.kind == Footprint::Kind::kTriangle ? f.hy
                                                : f.hx;
}

/// Returns a box along the world's axes in single precision.
AxisBox rounded(double min_x, double max_x, double min_y, double max_y, double min_z,
                double max_z) {
  return {static_cast<float>(min_x), static_cast<float>(max_x), static_cast<float>(min_y),
          static_cast<float>(max_y), static_cast<float>(min_z), static_cast<float>(max_z)};
}

/// Returns a number in single precision that is larger.
float above(double number) {
  return std::nextafter(static_cast<float>(number), std::numeric_limits<float>::infinity());
}

/// Returns whether the other footprint lies within a box that moves with it, far enough from its
/// sides that rounding does not matter.
bool hides(const Footprint& box, const Footprint& other) {
  if (isFixed(other)) return false;
  const double dx = other.x - box.x, dy = other.y - box.y;
  const double reach = radiusOf(other) + kHidden;
  return std::abs(dx * box.c + dy * box.s) + reach <= box.hx &&
         std::abs(dy * box.c - dx * box.s) + reach <= box.hy;
}

/// Restricts a range of heights, which the other footprint shares, to those that it does not have.
void keepOff(const Footprint& other, double* low, double* high) {
  if (*high - other.z_max > other.z_min - *low) {
    *low = other.z_max;
  } else {
    *high = other.z_min;
  }
}

/// Returns the separation of two boxes along the two axes of `a`: the larger of both gaps.
double gapAlongAxes(const Footprint& a, const Footprint& b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  const double cos = std::abs(a.c * b.c + a.s * b.s), sin = std::abs(a.s * b.c - a.c * b.s);
  const double along = std::abs(dx * a.c + dy * a.s) - a.hx - (cos * b.hx + sin * b.hy);
  const double across = std::abs(-dx * a.s + dy * a.c) - a.hy - (sin * b.hx + cos * b.hy);
  return std::max(along, across);
}

double gapToCircle(const Footprint& box, const Footprint& circle) {
  const double dx = circle.x - box.x, dy = circle.y - box.y;
  const double along = std::abs(dx * box.c + dy * box.s) - box.hx;
  const double across = std::abs(-dx * box.s + dy * box.c) - box.hy;
  if (along < 0 || across < 0) return std::max(along, across) - circle.hx;
  return lengthOf(along, across) - circle.hx;
}

}  // namespace

double gap(const Footprint& a, const Footprint& b) {
  if (a.kind == Footprint::Kind::kTriangle) return gapToTriangle(*a.triangle, b);
  if (b.kind == Footprint::Kind::kTriangle) return gapToTriangle(*b.triangle, a);
  const bool box_a = a.kind == Footprint::Kind::kBox, box_b = b.kind == Footprint::Kind::kBox;
  if (box_a && box_b) return std::max(gapAlongAxes(a, b), gapAlongAxes(b, a));
  if (box_a) return gapToCircle(a, b);
  if (box_b) return gapToCircle(b, a);
  return lengthOf(b.x - a.x, b.y - a.y) - a.hx - b.hx;
}

void Obstacles::clear() {
  entries_.clear();
  spots_.clear();
  movers_.clear();
  mover_corner_.clear();
  radius_.clear();
  silhouettes_.clear();
  boxes_.clear();
  free_.clear();
  cells_.clear();
  everywhere_.clear();
  origin_x_ = origin_y_ = 0;
  columns_ = rows_ = 0;
}

int Obstacles::add(const Footprint& footprint) {
  int handle = static_cast<int>(entries_.size());
  if (free_.empty()) {
    entries_.emplace_back();
    spots_.emplace_back();
  } else {
    handle = free_.back();
    free_.pop_back();
  }
  entries_[handle].used = true;
  setFootprint(handle, footprint);
  cover(boxOf(footprint));
  link(handle, entries_[handle].place, boxOf(footprint));
  return handle;
}

void Obstacles::update(int handle, const Footprint& footprint) {
  Entry& entry = entries_[handle];
  setFootprint(handle, footprint);
  const Box box = boxOf(footprint);
  if (!entry.place.everywhere && isInside(box) && range(box) == entry.place.range) return;
  unlink(handle, entry.place);
  cover(box);
  link(handle, entry.place, box);
}

void Obstacles::remove(int handle) {
  unlink(handle, entries_[handle].place);
  boxes_.remove(handle);
  entries_[handle] = Entry();
  free_.push_back(handle);
}

void Obstacles::setMover(int robot, std::vector<Footprint> local) {
  if (robot >= static_cast<int>(movers_.size())) {
    movers_.resize(robot + 1);
    mover_corner_.resize(robot + 1);
    radius_.resize(robot + 1);
    silhouettes_.resize(robot + 1);
  }
  radius_[robot] = 0;
  for (const Footprint& f : local) {
    radius_[robot] = std::max(radius_[robot], lengthOf(f.x, f.y) + radiusOf(f));
  }
  Mover& mover = movers_[robot];
  mover.world = local;
  mover.world_x = kInfinity;  // not computed yet
  mover.local = std::move(local);
  silhouettes_[robot] = Silhouette(mover.local, radius_[robot]);
  linkMover(robot);
}

void Obstacles::raise(int robot, int model, double by) {
  for (auto* footprints : {&movers_[robot].local, &movers_[robot].world}) {
    for (Footprint& footprint : *footprints) {
      if (footprint.model != model) continue;
      footprint.z_min += by;
      footprint.z_max += by;
    }
  }
  silhouettes_[robot] = Silhouette(movers_[robot].local, radius_[robot]);
  putMover(robot);
}

void Obstacles::removeMover(int robot) {
  unlink(~robot, movers_[robot].place);
  boxes_.remove(~robot);
  const int last = static_cast<int>(movers_.size()) - 1;
  if (robot != last) {
    unlink(~last, movers_[last].place);
    boxes_.remove(~last);
    movers_[robot] = std::move(movers_[last]);
    radius_[robot] = radius_[last];
    silhouettes_[robot] = silhouettes_[last];
  }
  movers_.pop_back();
  mover_corner_.pop_back();
  radius_.pop_back();
  silhouettes_.pop_back();
  if (robot != last) linkMover(robot);
}

void Obstacles::follow(int robot, double way) {
  const Mover& mover = movers_[robot];
  const double dx = fleet_.x[robot] - mover.x, dy = fleet_.y[robot] - mover.y;
  const double room = kSlack - way;
  if (dx * dx + dy * dy > std::max(0.0, room * room)) linkMover(robot);
}

const std::vector<Footprint>& Obstacles::footprints(int robot) const {
  const Mover& mover = movers_[robot];
  const double x = fleet_.x[robot], y = fleet_.y[robot], yaw = fleet_.yaw[robot];
  if (mover.world_x == x && mover.world_y == y && mover.world_yaw == yaw) return mover.world;
  placeAll(mover.local, x, y, yaw, &mover.world);
  mover.world_x = x;
  mover.world_y = y;
  mover.world_yaw = yaw;
  return mover.world;
}

void Obstacles::linkMover(int robot) {
  Mover& mover = movers_[robot];
  mover.x = fleet_.x[robot];
  mover.y = fleet_.y[robot];
  unlink(~robot, mover.place);
  cover(boxOfMover(robot));
  link(~robot, mover.place, boxOfMover(robot));
  putMover(robot);
}

/// Tells scans where a mover is, and how high it reaches.
void Obstacles::putMover(int robot) {
  double z_min = kInfinity, z_max = -kInfinity;
  for (const Footprint& f : movers_[robot].local) {
    z_min = std::min(z_min, f.z_min);
    z_max = std::max(z_max, f.z_max);
  }
  const Box b = boxOfMover(robot);
  boxes_.put(~robot, rounded(b.min_x, b.max_x, b.min_y, b.max_y, z_min, z_max));
}

/// The box that hides all others at the most heights.
Obstacles::Silhouette::Silhouette(const std::vector<Footprint>& local, double of_mover)
    : radius(above(of_mover)) {
  for (const Footprint& box : local) {
    if (box.kind != Footprint::Kind::kBox) continue;
    double low = box.z_min, high = box.z_max;
    for (const Footprint& other : local) {
      if (high - low < z_max - z_min) break;  // the one before is better
      if (&other == &box || other.z_max < low || other.z_min > high) continue;
      if (!hides(box, other)) keepOff(other, &low, &high);
    }
    const float lowest = above(low), highest = -above(-high);
    if (!(highest - lowest > z_max - z_min)) continue;
    x = box.x;
    y = box.y;
    c = box.c;
    s = box.s;
    hx = box.hx;
    hy = box.hy;
    z_min = lowest;
    z_max = highest;
    model = box.model;
  }
}

Obstacles::CellRange Obstacles::range(double min_x, double max_x, double min_y,
                                      double max_y) const {
  const auto column = [this](double x) {
    return static_cast<int>(std::clamp(std::floor((x - origin_x_) / kCell), -1.0, columns_ + 0.0));
  };
  const auto row = [this](double y) {
    return static_cast<int>(std::clamp(std::floor((y - origin_y_) / kCell), -1.0, rows_ + 0.0));
  };
  return {std::max(column(min_x), 0), std::min(column(max_x), columns_ - 1),
          std::max(row(min_y), 0), std::min(row(max_y), rows_ - 1)};
}

Obstacles::Box Obstacles::boxOf(const Footprint& f) {
  return {f.x - halfX(f), f.x + halfX(f), f.y - halfY(f), f.y + halfY(f)};
}

Obstacles::Box Obstacles::boxOfMover(int robot) const {
  const Mover& m = movers_[robot];
  const double half = radius_[robot] + kSlack;
  return {m.x - half, m.x + half, m.y - half, m.y + half};
}

bool Obstacles::isInside(const Box& box) const {
  return box.min_x >= origin_x_ && box.min_y >= origin_y_ &&
         box.max_x <= origin_x_ + columns_ * kCell && box.max_y <= origin_y_ + rows_ * kCell;
}

void Obstacles::setFootprint(int handle, const Footprint& f) {
  entries_[handle].footprint = f;
  Spot& spot = spots_[handle];
  spot.x = static_cast<float>(f.x);
  spot.y = static_cast<float>(f.y);
  const double margin = kSpotMargin + kFloatMargin * (std::abs(f.x) + std::abs(f.y));
  spot.radius = static_cast<float>(radiusOf(f) + margin);
  spot.z_min = -above(-f.z_min);
  spot.z_max = above(f.z_max);
  const Box b = boxOf(f);
  boxes_.put(handle, rounded(b.min_x, b.max_x, b.min_y, b.max_y, f.z_min, f.z_max));
}

void Obstacles::link(int handle, Place& place, const Box& box) {
  place.linked = true;
  place.range = range(box);
  const CellRange& cells = place.range;
  Corner& corner = handle < 0 ? mover_corner_[~handle] : spots_[handle].corner;
  corner = {static_cast<std::int16_t>(cells.x0), static_cast<std::int16_t>(cells.y0)};
  const long count = (cells.x1 - cells.x0 + 1L) * (cells.y1 - cells.y0 + 1L);
  place.everywhere = !isInside(box) || count > kMostCellsEach;
  if (place.everywhere) {
    everywhere_.push_back(handle);
    return;
  }
  const CellRange& r = place.range;
  for (int cy = r.y0; cy <= r.y1; ++cy) {
    for (int cx = r.x0; cx <= r.x1; ++cx) {
      auto& list = cells_[cell(cx, cy)];
      list.insert(handle < 0 ? list.begin() : list.end(), handle);
    }
  }
}

void Obstacles::unlink(int handle, Place& place) {
  if (!place.linked) return;
  place.linked = false;
  const auto drop = [handle](auto& list) {
    list.erase(std::find(list.begin(), list.end(), handle));
  };
  if (place.everywhere) {
    drop(everywhere_);
    return;
  }
  for (int cy = place.range.y0; cy <= place.range.y1; ++cy) {
    for (int cx = place.range.x0; cx <= place.range.x1; ++cx) drop(cells_[cell(cx, cy)]);
  }
}

void Obstacles::cover(const Box& box) {
  const double margin = 8 * kCell;  // so that a driver at the rim seldom makes the grid grow
  const bool empty = columns_ == 0;
  if (!empty && isInside(box)) return;
  const double x0 = std::floor(std::min(empty ? box.min_x : origin_x_, box.min_x - margin));
  const double y0 = std::floor(std::min(empty ? box.min_y : origin_y_, box.min_y - margin));
  const double x1 =
      std::ceil(std::max(empty ? box.max_x : origin_x_ + columns_ * kCell, box.max_x + margin));
  const double y1 =
      std::ceil(std::max(empty ? box.max_y : origin_y_ + rows_ * kCell, box.max_y + margin));
  if (!(x1 - x0 <= kMaxCells * kCell && y1 - y0 <= kMaxCells * kCell)) return;

  origin_x_ = x0;
  origin_y_ = y0;
  columns_ = static_cast<int>(std::lround((x1 - x0) / kCell));
  rows_ = static_cast<int>(std::lround((y1 - y0) / kCell));
  cells_.assign(static_cast<std::size_t>(columns_) * rows_, {});
  everywhere_.clear();
  for (std::size_t handle = 0; handle < entries_.size(); ++handle) {
    Entry& entry = entries_[handle];
    if (entry.place.linked) link(static_cast<int>(handle), entry.place, boxOf(entry.footprint));
  }
  for (std::size_t robot = 0; robot < movers_.size(); ++robot) {
    const int index = static_cast<int>(robot);
    if (movers_[robot].place.linked) link(~index, movers_[robot].place, boxOfMover(index));
  }
}

void Obstacles::castMover(int robot, double x, double y, double z, double dx, double dy,
                          RayHit* hit) const {
  // Most rays miss the circle around the mover, so that its footprints need not be computed.
  const double ox = fleet_.x[robot] - x, oy = fleet_.y[robot] - y;
  const double radius = radius_[robot];
  const double along = ox * dx + oy * dy, across = ox * dy - oy * dx;
  if (std::abs(across) > radius || along < -radius || along - radius > hit->range) return;
  for (const Footprint& f : footprints(robot)) {
    if (z < f.z_min || z > f.z_max) continue;
    const double t = castFootprint(f, x, y, z, dx, dy, hit->range);
    hit->meet(t, f.model);
  }
}

RayHit Obstacles::cast(double x, double y, double z, double dx, double dy, double range,
                       int group) const {
  RayHit hit{range, -1};
  const auto test = [&](int handle) {
    if (handle < 0) {
      if (~handle != group) castMover(~handle, x, y, z, dx, dy, &hit);
      return;
    }
    const Footprint& f = entries_[handle].footprint;
    if (z < f.z_min || z > f.z_max || (group >= 0 && f.group == group)) return;
    const double t = castFootprint(f, x, y, z, dx, dy, range);
    hit.meet(t, f.model);
  };
  for (int handle : everywhere_) test(handle);

  // Traverses the cells along the ray (Amanatides and Woo 1987), in units of cells.
  const double px = (x - origin_x_) / kCell, py = (y - origin_y_) / kCell;
  int cx = static_cast<int>(std::floor(px)), cy = static_cast<int>(std::floor(py));
  const int step_x = dx < 0 ? -1 : 1, step_y = dy < 0 ? -1 : 1;
  const double delta_x = dx == 0 ? kInfinity : kCell / std::abs(dx);
  const double delta_y = dy == 0 ? kInfinity : kCell / std::abs(dy);
  double next_x = dx == 0 ? kInfinity : (dx < 0 ? px - cx : cx + 1 - px) * delta_x;
  double next_y = dy == 0 ? kInfinity : (dy < 0 ? py - cy : cy + 1 - py) * delta_y;
  double entered = 0;
  while (entered < hit.range) {
    if (cx >= 0 && cx < columns_ && cy >= 0 && cy < rows_) {
      for (int handle : cells_[cell(cx, cy)]) test(handle);
    }
    entered = std::min(next_x, next_y);
    if (next_x < next_y) {
      cx += step_x;
      next_x += delta_x;
    } else {
      cy += step_y;
      next_y += delta_y;
    }
  }
  if (hit.model < 0) hit.range = kInfinity;
  return hit;
}

}  // namespace kiva
