// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "core/state/places/floors.h"
#include "core/state/places/footprints.h"
#include "core/state/world_state.h"

namespace kiva {
namespace {

constexpr double kMostMapCells = 16e6;
constexpr double kFiner = 0.01;  // [m], step in which cells are made coarser
constexpr double kEdge = 1e-6;   // [m]
constexpr double kAround = 1;    // [m] around the floor in which walls are drawn

/// Returns the height above the floor at which robots look [m].
double laserHeight(const Fleet& fleet) {
  for (const Robot& robot : fleet.robots) {
    if (robot.laser.fitted) return robot.laser.z;
  }
  return LaserParameters().z;
}

/// Returns whether lasers see it where it is built, or where it stands for long.
bool isMapped(const Scene& world, const Model& model) {
  if (model.owner->occupies(world, model) == Occupancy::kFree) return false;
  if (model.kind == ModelKind::kStorageUnit) return true;
  const auto& people = world.people.walkers;
  const bool is_person = std::any_of(people.begin(), people.end(), [&](const Walker& walker) {
    return walker.model == model.slot;
  });
  return model.isStatic() && !is_person;
}

/// Calls visit(footprint) for each part of the warehouse that a level laser sees.
template <typename Visit>
void forEachSeen(const Scene& world, Visit visit) {
  const double z = world.floor.extent.z + laserHeight(world.fleet);
  for (const auto& model : world.models) {
    if (!model || !isMapped(world, *model)) continue;
    for (const CollisionGeometry& geometry : model->geometries) {
      if (geometry.handle < 0) continue;  // it is carried
      const Footprint& footprint = world.obstacles[geometry.handle];
      if (footprint.z_min <= z && footprint.z_max >= z) visit(footprint);
    }
  }
}

/// Returns the area of the map: the floor with the walls around it, or, without a floor, all that
/// lasers see.
FloorExtent areaOf(const Scene& world) {
  FloorExtent area = world.floor.extent;
  if (area.min_x < area.max_x) {
    return {area.min_x - kAround, area.max_x + kAround, area.min_y - kAround, area.max_y + kAround,
            area.z};
  }
  area = {1e300, -1e300, 1e300, -1e300, area.z};
  forEachSeen(world, [&](const Footprint& f) {
    const double reach = radiusOf(f) + kAround;
    area.min_x = std::min(area.min_x, f.x - reach);
    area.max_x = std::max(area.max_x, f.x + reach);
    area.min_y = std::min(area.min_y, f.y - reach);
    area.max_y = std::max(area.max_y, f.y + reach);
  });
  return area.min_x < area.max_x ? area : FloorExtent();
}

/// Returns the resolution, or the next coarser one with which the map has few enough cells.
double fitted(const FloorExtent& area, double resolution) {
  const double least =
      std::sqrt((area.max_x - area.min_x) * (area.max_y - area.min_y) / kMostMapCells);
  return least <= resolution ? resolution : std::ceil(least / kFiner) * kFiner;
}

/// Makes the map's cells: free where the floor is, unknown elsewhere.
LaserMap blankMap(const Scene& world, double resolution) {
  const FloorExtent area = areaOf(world);
  LaserMap map;
  map.resolution = fitted(area, resolution);
  map.x = std::floor(area.min_x / map.resolution + kEdge) * map.resolution;
  map.y = std::floor(area.min_y / map.resolution + kEdge) * map.resolution;
  map.z = area.z;
  map.columns = static_cast<int>(std::ceil((area.max_x - map.x) / map.resolution - kEdge));
  map.rows = static_cast<int>(std::ceil((area.max_y - map.y) / map.resolution - kEdge));
  map.cells.reserve(static_cast<std::size_t>(map.columns) * map.rows);
  const FloorCover cover(world);
  for (int row = 0; row < map.rows; ++row) {
    for (int column = 0; column < map.columns; ++column) {
      const bool is_floor = cover.covers(map.x + (column + 0.5) * map.resolution,
                                         map.y + (row + 0.5) * map.resolution, 0);
      map.cells.push_back(is_floor ? LaserMap::kFree : LaserMap::kUnknown);
    }
  }
  return map;
}

/// Marks the cells that a footprint reaches into.
void draw(const Footprint& footprint, LaserMap* map) {
  const double reach = radiusOf(footprint);
  const auto index = [&](double at, double first, int last) {
    return static_cast<int>(std::clamp((at - first) / map->resolution, 0.0, last + 0.0));
  };
  Footprint cell;
  cell.hx = cell.hy = map->resolution / 2 - kEdge;
  const int right = index(footprint.x + reach, map->x, map->columns - 1);
  const int high = index(footprint.y + reach, map->y, map->rows - 1);
  for (int row = index(footprint.y - reach, map->y, map->rows - 1); row <= high; ++row) {
    cell.y = map->y + (row + 0.5) * map->resolution;
    for (int column = index(footprint.x - reach, map->x, map->columns - 1); column <= right;
         ++column) {
      cell.x = map->x + (column + 0.5) * map->resolution;
      if (gap(cell, footprint) > 0) continue;
      map->cells[static_cast<std::size_t>(row) * map->columns + column] = LaserMap::kOccupied;
    }
  }
}

}  // namespace

LaserMap World::laserMap(double resolution) const {
  if (!(resolution >= kLeastMapResolution && resolution <= kMostMapResolution)) {
    throw std::invalid_argument("the resolution of a map must be from 0.01 to 1 m");
  }
  const Scene& world = state_->view;
  LaserMap map = blankMap(world, resolution);
  if (map.cells.empty()) return map;
  forEachSeen(world, [&map](const Footprint& footprint) { draw(footprint, &map); });
  return map;
}

}  // namespace kiva
