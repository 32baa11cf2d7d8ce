// SPDX-License-Identifier: Apache-2.0
#include "obstacles.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "ray.h"

namespace kiva {
namespace {

constexpr double kCell = 1.0;    // [m]
constexpr int kMaxCells = 2048;  // a side; farther out nothing is indexed by cell
constexpr double kInfinity = std::numeric_limits<double>::infinity();

double halfX(const Footprint& f) {
  return f.kind == Footprint::Kind::kBox ? std::abs(f.c) * f.hx + std::abs(f.s) * f.hy : f.hx;
}
double halfY(const Footprint& f) {
  return f.kind == Footprint::Kind::kBox ? std::abs(f.s) * f.hx + std::abs(f.c) * f.hy : f.hx;
}

/// Separation of two boxes along the two axes of `a`: the larger gap of both.
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
  return std::hypot(along, across) - circle.hx;
}

/// Entry distance of the ray (x, y) + t (dx, dy) into a circle, or +inf.
double castCircle(const Footprint& f, double radius, double x, double y, double dx, double dy) {
  const double ox = x - f.x, oy = y - f.y;
  const double b = ox * dx + oy * dy;
  const double c = ox * ox + oy * oy - radius * radius;
  const double discriminant = b * b - c;
  if (discriminant < 0 || c < 0 || b > 0) return kInfinity;
  return -b - std::sqrt(discriminant);
}

/// The slab test (Kay and Kajiya 1986) in the box's own axes. A ray that starts inside passes, as
/// it does in Bullet.
double castBox(const Footprint& f, double x, double y, double dx, double dy) {
  const double ox = x - f.x, oy = y - f.y;
  const double px = ox * f.c + oy * f.s, py = -ox * f.s + oy * f.c;
  const double vx = dx * f.c + dy * f.s, vy = -dx * f.s + dy * f.c;
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
  return enter <= leave && enter >= 0 ? enter : kInfinity;
}

double castOne(const Footprint& f, double x, double y, double z, double dx, double dy,
               double range) {
  switch (f.kind) {
    case Footprint::Kind::kBox:
      return castBox(f, x, y, dx, dy);
    case Footprint::Kind::kCircle:
      return castCircle(f, f.hx, x, y, dx, dy);
    case Footprint::Kind::kSphere: {
      const double up = z - 0.5 * (f.z_min + f.z_max);
      return castCircle(f, std::sqrt(std::max(0.0, f.hx * f.hx - up * up)), x, y, dx, dy);
    }
    case Footprint::Kind::kOther:
      return castBody(*f.body, {x, y, z}, {dx, dy, 0}, range);
  }
  return kInfinity;
}

}  // namespace

double gap(const Footprint& a, const Footprint& b) {
  const bool box_a = a.kind == Footprint::Kind::kBox, box_b = b.kind == Footprint::Kind::kBox;
  if (box_a && box_b) return std::max(gapAlongAxes(a, b), gapAlongAxes(b, a));
  if (box_a) return gapToCircle(a, b);
  if (box_b) return gapToCircle(b, a);
  return std::hypot(b.x - a.x, b.y - a.y) - a.hx - b.hx;
}

int Obstacles::add(const Footprint& footprint) {
  int handle = static_cast<int>(entries_.size());
  if (free_.empty()) {
    entries_.emplace_back();
  } else {
    handle = free_.back();
    free_.pop_back();
  }
  entries_[handle].used = true;
  entries_[handle].footprint = footprint;
  cover(entries_[handle].footprint);
  link(handle);
  return handle;
}

void Obstacles::update(int handle, const Footprint& footprint) {
  Entry& entry = entries_[handle];
  entry.footprint = footprint;
  if (!entry.everywhere && isInside(footprint) && rangeOf(footprint) == entry.range) return;
  unlink(handle);
  cover(entry.footprint);
  link(handle);
}

void Obstacles::remove(int handle) {
  unlink(handle);
  entries_[handle] = Entry();
  free_.push_back(handle);
}

Obstacles::Range Obstacles::range(double min_x, double max_x, double min_y, double max_y) const {
  const auto column = [this](double x) {
    return static_cast<int>(std::clamp(std::floor((x - origin_x_) / kCell), -1.0, columns_ + 0.0));
  };
  const auto row = [this](double y) {
    return static_cast<int>(std::clamp(std::floor((y - origin_y_) / kCell), -1.0, rows_ + 0.0));
  };
  return {std::max(column(min_x), 0), std::min(column(max_x), columns_ - 1),
          std::max(row(min_y), 0), std::min(row(max_y), rows_ - 1)};
}

Obstacles::Range Obstacles::rangeOf(const Footprint& f) const {
  return range(f.x - halfX(f), f.x + halfX(f), f.y - halfY(f), f.y + halfY(f));
}

bool Obstacles::isInside(const Footprint& f) const {
  return f.x - halfX(f) >= origin_x_ && f.y - halfY(f) >= origin_y_ &&
         f.x + halfX(f) <= origin_x_ + columns_ * kCell &&
         f.y + halfY(f) <= origin_y_ + rows_ * kCell;
}

void Obstacles::link(int handle) {
  Entry& entry = entries_[handle];
  entry.range = rangeOf(entry.footprint);
  const Range& r = entry.range;
  entry.everywhere = !isInside(entry.footprint);
  if (entry.everywhere) {
    everywhere_.push_back(handle);
    return;
  }
  for (int cy = r.y0; cy <= r.y1; ++cy) {
    for (int cx = r.x0; cx <= r.x1; ++cx) cells_[cell(cx, cy)].push_back(handle);
  }
}

void Obstacles::unlink(int handle) {
  const auto drop = [handle](std::vector<int>& list) {
    const auto at = std::find(list.begin(), list.end(), handle);
    *at = list.back();
    list.pop_back();
  };
  const Entry& entry = entries_[handle];
  if (entry.everywhere) {
    drop(everywhere_);
    return;
  }
  for (int cy = entry.range.y0; cy <= entry.range.y1; ++cy) {
    for (int cx = entry.range.x0; cx <= entry.range.x1; ++cx) drop(cells_[cell(cx, cy)]);
  }
}

void Obstacles::cover(const Footprint& f) {
  const double margin = 8 * kCell;  // so that a driver at the rim does not make the grid grow often
  const double min_x = f.x - halfX(f), max_x = f.x + halfX(f);
  const double min_y = f.y - halfY(f), max_y = f.y + halfY(f);
  const bool empty = columns_ == 0;
  if (!empty && min_x >= origin_x_ && min_y >= origin_y_ && max_x <= origin_x_ + columns_ * kCell &&
      max_y <= origin_y_ + rows_ * kCell) {
    return;
  }
  const double x0 = std::floor(std::min(empty ? min_x : origin_x_, min_x - margin));
  const double y0 = std::floor(std::min(empty ? min_y : origin_y_, min_y - margin));
  const double x1 =
      std::ceil(std::max(empty ? max_x : origin_x_ + columns_ * kCell, max_x + margin));
  const double y1 = std::ceil(std::max(empty ? max_y : origin_y_ + rows_ * kCell, max_y + margin));
  if (!(x1 - x0 <= kMaxCells * kCell && y1 - y0 <= kMaxCells * kCell)) return;

  origin_x_ = x0;
  origin_y_ = y0;
  columns_ = static_cast<int>(std::lround((x1 - x0) / kCell));
  rows_ = static_cast<int>(std::lround((y1 - y0) / kCell));
  cells_.assign(static_cast<std::size_t>(columns_) * rows_, {});
  everywhere_.clear();
  for (std::size_t handle = 0; handle < entries_.size(); ++handle) {
    const bool is_new = &entries_[handle].footprint == &f;
    if (entries_[handle].used && !is_new) link(static_cast<int>(handle));
  }
}

RayHit Obstacles::cast(double x, double y, double z, double dx, double dy, double range,
                       int group) const {
  RayHit hit{range, -1};
  const auto test = [&](int handle) {
    const Footprint& f = entries_[handle].footprint;
    if (z < f.z_min || z > f.z_max || (group >= 0 && f.group == group)) return;
    const double t = castOne(f, x, y, z, dx, dy, range);
    if (t < hit.range) hit = {t, f.model};
  };
  for (int handle : everywhere_) test(handle);

  // Cell by cell along the ray (Amanatides and Woo 1987), in units of cells.
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
