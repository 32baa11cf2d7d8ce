// SPDX-License-Identifier: Apache-2.0
#include "core/motion/wheels/ground.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/state/places/floors.h"
#include "core/state/world/random_stream.h"

namespace kiva {
namespace {

constexpr double kFarthest = 1e6;  // [m] from the origin
constexpr double kOffLine = 0.1;   // [m] off its line up to which a robot may drive

/// A cell of the grid, by its grid point.
struct GridCell {
  std::int64_t column, row;
};

GridCell cellAt(const WorldSettings& settings, double x, double y) {
  return {std::llround(x / settings.grid_spacing), std::llround(y / settings.grid_spacing)};
}

bool isSlippery(const WorldSettings& settings, const GridCell& cell) {
  RandomStream random(settings.options.seed, Matter::kFloor,
                      static_cast<std::uint64_t>(cell.column),
                      static_cast<std::uint64_t>(cell.row));
  return random.chance(settings.realism.floor.slippery_cells);
}

/// Returns the friction of the surface at (x, y) as built.
double builtFriction(const Scene& world, double x, double y) {
  const double usual = world.floor.friction;
  return world.floor.cover ? world.floor.cover->frictionAt(x, y, usual) : usual;
}

/// Returns the smallest friction as built in a rectangle [m].
double leastBuiltFriction(const FloorState& floor, const FloorPatch& area) {
  const double usual = floor.friction;
  return floor.cover ? floor.cover->leastFriction(area, usual) : usual;
}

/// Returns the friction of the uppermost patch at (x, y); without a patch, that of the cell.
double frictionAt(const Scene& world, double x, double y) {
  for (auto patch = world.floor.patches.rbegin(); patch != world.floor.patches.rend(); ++patch) {
    if (patch->has(x, y)) return patch->friction;
  }
  const FloorRealism& real = world.settings.realism.floor;
  const double built = builtFriction(world, x, y);
  if (!real.enabled || !isSlippery(world.settings, cellAt(world.settings, x, y))) return built;
  return std::min(real.friction, built);
}

/// Returns the smallest friction in a rectangle [m].
double leastFriction(const Scene& world, const FloorPatch& area) {
  double least = leastBuiltFriction(world.floor, area);
  for (const FloorPatch& patch : world.floor.patches) {
    if (patch.meets(area)) least = std::min(least, patch.friction);
  }
  const FloorRealism& real = world.settings.realism.floor;
  if (!real.enabled || real.friction >= least) return least;
  const GridCell first = cellAt(world.settings, area.min_x, area.min_y);
  const GridCell last = cellAt(world.settings, area.max_x, area.max_y);
  for (std::int64_t row = first.row; row <= last.row; ++row) {
    for (std::int64_t column = first.column; column <= last.column; ++column) {
      if (isSlippery(world.settings, {column, row})) return real.friction;
    }
  }
  return least;
}

/// Returns the area on which a robot's wheels stand until its reference has come to its goal.
FloorPatch areaAhead(const FleetState& f, int robot) {
  const bool drives = f.tasks[robot].isAt(MotionSegment::Kind::kDrive);
  const double way = drives ? f.reference_end[robot] - f.reference[robot] : 0;
  const double to_x = f.x[robot] + way * std::cos(f.yaw[robot]);
  const double to_y = f.y[robot] + way * std::sin(f.yaw[robot]);
  const double reach = f.robots[robot].drive.wheel_separation / 2 + kOffLine;
  return {std::min(f.x[robot], to_x) - reach, std::max(f.x[robot], to_x) + reach,
          std::min(f.y[robot], to_y) - reach, std::max(f.y[robot], to_y) + reach, 0};
}

}  // namespace

FloorPatch readFloorPatch(const Parameters& p) {
  const auto centre = p.numbers("centre", {0, 0}), size = p.numbers("size", {1, 1});
  for (const double place : {centre[0], centre[1], size[0], size[1]}) {
    if (std::abs(place) <= kFarthest) continue;
    throw DescriptionError(p.where() + ": the patch is more than 1e6 m large or away");
  }
  if (!(size[0] > 0 && size[1] > 0)) {
    throw DescriptionError(p.where() + ": <size> is " + p.text("size", "") +
                           "; two lengths above 0 were expected");
  }
  const double friction = p.number("friction", 0.3, 0, kMostFriction);
  p.rejectUnread();
  return {centre[0] - size[0] / 2, centre[0] + size[0] / 2, centre[1] - size[1] / 2,
          centre[1] + size[1] / 2, friction};
}

Ground groundOf(const Scene& world) {
  return {world.settings.gravityDown(), {world.floor.friction, world.floor.friction}};
}

bool isPatchy(const Scene& world) {
  return !world.floor.patches.empty() || world.settings.realism.floor.enabled || world.floor.cover;
}

Ground groundUnder(const Scene& world, int robot) {
  Ground ground = groundOf(world);
  if (!isPatchy(world)) return ground;
  const Fleet& f = world.fleet;
  const double half = f.robots[robot].drive.wheel_separation / 2;
  const double left_x = -std::sin(f.yaw[robot]) * half, left_y = std::cos(f.yaw[robot]) * half;
  for (int wheel = 0; wheel < 2; ++wheel) {
    const double side = wheel == 0 ? 1 : -1;
    ground.friction[wheel] =
        frictionAt(world, f.x[robot] + side * left_x, f.y[robot] + side * left_y);
  }
  return ground;
}

double knownFriction(const Scene& world, int robot) {
  return world.floor.cover ? leastBuiltFriction(world.floor, areaAhead(world.fleet, robot))
                           : world.floor.friction;
}

Ground groundAhead(const Scene& world, int robot) {
  Ground ground = groundOf(world);
  if (!isPatchy(world)) return ground;
  ground.friction[0] = ground.friction[1] = leastFriction(world, areaAhead(world.fleet, robot));
  return ground;
}

}  // namespace kiva
