// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "core/state/places/floors.h"
#include "core/state/world_state.h"

namespace kiva {
namespace {

constexpr double kHigh = 2.5;       // [m]: a robot with a load passes beneath
constexpr double kTurning = 0.57;   // [m], reach of a loaded robot's corners as it turns
constexpr double kRounding = 1e-6;  // [m]
constexpr int kMostCells = 2000;    // a side

/// The grid points along one axis whose cells lie within min … max.
struct Line {
  int first = 0, count = 0;  // in cells from the origin
};

Line pointsWithin(double min, double max, double spacing) {
  const double from = std::ceil((min - kRounding) / spacing + 0.5);
  const double to = std::floor((max + kRounding) / spacing - 0.5);
  const double half = kMostCells / 2;
  const double first = std::max(from, -half), last = std::min(to, half - 1);
  return {static_cast<int>(first), std::max(0, static_cast<int>(last - first) + 1)};
}

bool isInTheWay(const FloorExtent& floor, const Footprint& other) {
  return !isLow(floor, other.z_max) && other.z_min < floor.z + kHigh;
}

/// Returns the extent of a world without a floor: that of all its models, which robots can't drive
/// on.
FloorExtent withoutFloor(const Scene& world) {
  FloorExtent all{1e300, -1e300, 1e300, -1e300, 0};
  for (const auto& model : world.models) {
    if (!model || model->owner->occupies(world, *model) != Occupancy::kTaken) continue;
    for (const CollisionGeometry& geometry : model->geometries) {
      const Footprint& f = world.obstacles[geometry.handle];
      const double reach = radiusOf(f) + world.settings.grid_spacing;
      all.min_x = std::min(all.min_x, f.x - reach);
      all.max_x = std::max(all.max_x, f.x + reach);
      all.min_y = std::min(all.min_y, f.y - reach);
      all.max_y = std::max(all.max_y, f.y + reach);
    }
  }
  return all.min_x < all.max_x ? all : FloorExtent();
}

/// Returns whether a footprint reaches into the cell. Near a building a loaded robot needs room to
/// turn; belts and storage units are placed so that it has it.
bool reachesInto(const Footprint& other, std::uint8_t as, double x, double y, double spacing) {
  Footprint cell;
  cell.x = x;
  cell.y = y;
  cell.hx = cell.hy = spacing / 2 - kRounding;
  Footprint turn = cell;
  turn.kind = Footprint::Kind::kCircle;
  turn.hx = kTurning;
  return gap(cell, other) < 0 || (as == Occupancy::kTaken && gap(turn, other) < 0);
}

/// Returns the range of a footprint within a strip along x; that of a triangle is much less than
/// its box.
std::pair<double, double> extentWithin(const Footprint& f, double min_y, double max_y) {
  if (f.kind != Footprint::Kind::kTriangle) return {f.x - radiusOf(f), f.x + radiusOf(f)};
  std::pair<double, double> extent{1e300, -1e300};
  const auto add = [&extent](double x) {
    extent.first = std::min(extent.first, x);
    extent.second = std::max(extent.second, x);
  };
  for (int i = 0; i < 3; ++i) {
    const auto& a = (*f.triangle)[i];
    const auto& b = (*f.triangle)[(i + 1) % 3];
    if (a.Y() >= min_y && a.Y() <= max_y) add(a.X());
    for (const double y : {min_y, max_y}) {
      if ((a.Y() < y) != (b.Y() < y)) {
        add(a.X() + (b.X() - a.X()) * (y - a.Y()) / (b.Y() - a.Y()));
      }
    }
  }
  return extent;
}

void mark(const Footprint& other, std::uint8_t as, Occupancy* map) {
  const double margin = std::max(map->spacing, kTurning);
  const double reach = radiusOf(other) + margin;
  const auto index = [map](double at, double first) {
    return static_cast<int>(std::clamp((at - first) / map->spacing, -1.0, kMostCells + 0.0));
  };
  const int low = std::max(0, index(other.y - reach, map->y));
  const int high = std::min(map->rows - 1, index(other.y + reach, map->y));
  for (int row = low; row <= high; ++row) {
    const double y = map->y + row * map->spacing;
    const auto [min_x, max_x] = extentWithin(other, y - margin, y + margin);
    const int left = std::max(0, index(min_x - margin, map->x));
    const int right = std::min(map->columns - 1, index(max_x + margin, map->x));
    for (int column = left; column <= right; ++column) {
      const double x = map->x + column * map->spacing;
      std::uint8_t& cell = map->cells[static_cast<std::size_t>(row) * map->columns + column];
      if (cell < as && reachesInto(other, as, x, y, map->spacing)) cell = as;
    }
  }
}

}  // namespace

Occupancy World::occupancy() const {
  const Scene& world = state_->view;
  Occupancy map;
  map.spacing = world.settings.grid_spacing;
  const bool has_floor = world.floor.extent.max_x > world.floor.extent.min_x;
  const FloorExtent floor = has_floor ? world.floor.extent : withoutFloor(world);
  const Line x = pointsWithin(floor.min_x, floor.max_x, map.spacing);
  const Line y = pointsWithin(floor.min_y, floor.max_y, map.spacing);
  map.x = x.first * map.spacing;
  map.y = y.first * map.spacing;
  map.columns = x.count;
  map.rows = y.count;
  map.z = floor.z;
  const FloorCover cover(world);
  for (int row = 0; row < map.rows; ++row) {
    for (int column = 0; column < map.columns; ++column) {
      const bool is_floor =
          cover.covers(map.x + column * map.spacing, map.y + row * map.spacing, map.spacing / 2);
      map.cells.push_back(is_floor ? Occupancy::kFree : Occupancy::kTaken);
    }
  }
  for (const auto& model : world.models) {
    const std::uint8_t as = model ? model->owner->occupies(world, *model) : Occupancy::kFree;
    if (as == Occupancy::kFree) continue;
    for (const CollisionGeometry& geometry : model->geometries) {
      if (geometry.handle < 0) continue;  // it is carried
      const Footprint& footprint = world.obstacles[geometry.handle];
      if (isInTheWay(world.floor.extent, footprint)) mark(footprint, as, &map);
    }
  }
  return map;
}

}  // namespace kiva
