// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>

#include "core/state/world_state.h"

namespace kiva {
namespace {

constexpr double kLow = 0.005;      // [m]; what rises less above the ground is floor
constexpr double kHigh = 2.5;       // [m]: a robot with a load passes beneath
constexpr double kTurning = 0.57;   // [m]: as far as a loaded robot's corners reach as it turns
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

bool isInTheWay(const Footprint& other) { return other.z_max > kLow && other.z_min < kHigh; }

bool reachesInto(const Footprint& other, double x, double y, double spacing) {
  Footprint cell;
  cell.x = x;
  cell.y = y;
  cell.hx = cell.hy = spacing / 2 - kRounding;
  Footprint turn = cell;
  turn.kind = Footprint::Kind::kCircle;
  turn.hx = kTurning;
  return gap(cell, other) < 0 || gap(turn, other) < 0;
}

/// How far a footprint reaches from its centre at the most.
double reachOf(const Footprint& f) {
  const bool is_round = f.kind != Footprint::Kind::kBox && f.kind != Footprint::Kind::kTriangle;
  return is_round ? f.hx : std::hypot(f.hx, f.hy);
}

void mark(const Footprint& other, Occupancy* map) {
  const double reach = reachOf(other) + std::max(map->spacing, kTurning);
  const auto index = [map](double at, double first) {
    return static_cast<int>(std::clamp((at - first) / map->spacing, -1.0, kMostCells + 0.0));
  };
  const int left = std::max(0, index(other.x - reach, map->x));
  const int right = std::min(map->columns - 1, index(other.x + reach, map->x));
  const int low = std::max(0, index(other.y - reach, map->y));
  const int high = std::min(map->rows - 1, index(other.y + reach, map->y));
  for (int row = low; row <= high; ++row) {
    for (int column = left; column <= right; ++column) {
      const double x = map->x + column * map->spacing, y = map->y + row * map->spacing;
      char& cell = map->taken[static_cast<std::size_t>(row) * map->columns + column];
      if (!cell) cell = reachesInto(other, x, y, map->spacing);
    }
  }
}

}  // namespace

Occupancy World::occupancy() const {
  const WorldState& world = *state_;
  Occupancy map;
  map.spacing = world.grid_spacing;
  const Line x = pointsWithin(world.floor.min_x, world.floor.max_x, map.spacing);
  const Line y = pointsWithin(world.floor.min_y, world.floor.max_y, map.spacing);
  map.x = x.first * map.spacing;
  map.y = y.first * map.spacing;
  map.columns = x.count;
  map.rows = y.count;
  map.taken.assign(static_cast<std::size_t>(x.count) * y.count, 0);
  for (const auto& model : world.models) {
    if (!model || !model->owner->isObstacle()) continue;
    for (const CollisionGeometry& geometry : model->geometries) {
      const Footprint& footprint = world.obstacles[geometry.handle];
      if (isInTheWay(footprint)) mark(footprint, &map);
    }
  }
  return map;
}

}  // namespace kiva
