// SPDX-License-Identifier: Apache-2.0
#include "core/models/floors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <sstream>

#include "core/contact/activation.h"
#include "core/contact/upright.h"
#include "core/state/places/floors.h"
#include "core/state/places/footprints.h"

namespace kiva {
namespace {

constexpr double kJoint = 0.1;       // [m]; narrower gaps are joints of slabs
constexpr double kMostCells = 1e5;   // largest floor that is searched for gaps
constexpr double kLeastGrip = 1e-3;  // Coulomb coefficient at which a cell takes half a minute

void widen(FloorExtent* floor, const LevelSurface& surface) {
  floor->min_x = std::min(floor->min_x, surface.min_x);
  floor->max_x = std::max(floor->max_x, surface.max_x);
  floor->min_y = std::min(floor->min_y, surface.min_y);
  floor->max_y = std::max(floor->max_y, surface.max_y);
}

/// Calls visit(model, surface) for the level surfaces of all static models.
template <typename Visit>
void forSurfaces(const Scene& world, Visit visit) {
  for (const auto& model : world.models) {
    if (!model) continue;
    for (const LevelSurface& surface : model->level_surfaces) visit(surface);
  }
}

/// Returns whether wheels can drive from the floor onto it.
bool isAtFloor(const FloorState& floor, const LevelSurface& surface) {
  return std::abs(surface.z - floor.extent.z) <= kStep + 1e-9;
}

/// Returns the rank of a surface near that height, by which the floor's own is chosen; 0 elsewhere.
double extentAt(double height, const LevelSurface& surface) {
  if (std::abs(surface.z - height) > kSameHeight) return 0;
  return surface.is_plane ? std::numeric_limits<double>::infinity() : surface.area;
}

/// Returns the height of the largest surface; the higher one of two about as large, such as the two
/// sides of a slab.
std::optional<double> floorHeight(const Scene& world) {
  std::optional<double> plane;
  std::map<long long, std::pair<double, double>> bounded;  // by rounded height: area, height
  forSurfaces(world, [&](const LevelSurface& surface) {
    if (surface.is_plane) {
      plane = std::max(plane.value_or(surface.z), surface.z);
    } else {
      auto& [area, z] = bounded[std::llround(surface.z / kSameHeight)];
      z = area > 0 ? std::max(z, surface.z) : surface.z;
      area += surface.area;
    }
  });
  double most = plane ? 2 * kRoom : 0;
  for (const auto& [step, surface] : bounded) {
    if (!plane || surface.second > *plane) most = std::max(most, surface.first);
  }
  std::optional<double> height = plane;
  for (const auto& [step, surface] : bounded) {
    if (surface.first >= most / 2 && (!plane || surface.second > *plane)) height = surface.second;
  }
  return height;
}

void warnOfSlipperyFloor(EventLog& log, double friction) {
  std::ostringstream text;
  text << "the floor: its friction for wheels is " << friction << "; below " << kLeastGrip
       << " robots take minutes for a cell or can't move at all. The <mu> of the floor's <surface> "
          "and the <friction> of the robots' motion plugin set it";
  log.warn("floor friction", text.str());
}

/// Warns of low surfaces that count as floor: wheels cross them without a bump.
void warnOfBumps(const Scene& world, EventLog& log) {
  for (const auto& model : world.models) {
    if (!model) continue;
    for (const LevelSurface& surface : model->level_surfaces) {
      const double height = surface.z - world.floor.extent.z;
      if (height <= kSameHeight || height > kStep + 1e-9) continue;
      std::ostringstream text;
      text << model->name << " rises " << height << " m above the floor: what rises " << kStep
           << " m or less counts as floor, and robots cross it without a bump";
      return log.warn("floor bumps", text.str());
    }
  }
}

/// Returns the first grid point from which a grid line crosses a gap to another point on the floor.
std::optional<PathPoint> findGap(const Scene& world, const FloorCover& cover) {
  const FloorExtent& extent = world.floor.extent;
  const double cell = world.settings.grid_spacing;
  const auto is_gap = [&](double x, double y, double dx, double dy) {
    return !cover.covers(x, y, 0) && !cover.covers(x + kJoint * dx, y + kJoint * dy, 0);
  };
  const auto leads_over_gap = [&](double x, double y, double dx, double dy) {
    if (!cover.covers(x + dx * cell, y + dy * cell, 0)) return false;
    for (double share : {0.25, 0.5, 0.75}) {
      const double way = share * cell;
      if (is_gap(x + way * dx, y + way * dy, dx, dy) ||
          is_gap(x + way * dx, y + way * dy, -dx, -dy))
        return true;
    }
    return false;
  };
  for (double x = std::ceil(extent.min_x / cell) * cell; x <= extent.max_x; x += cell) {
    for (double y = std::ceil(extent.min_y / cell) * cell; y <= extent.max_y; y += cell) {
      if (!cover.covers(x, y, 0)) continue;
      if (leads_over_gap(x, y, 1, 0) || leads_over_gap(x, y, 0, 1)) return PathPoint{x, y};
    }
  }
  return std::nullopt;
}

/// Returns whether to search for gaps: not in planes, nor where a floor is so large that the search
/// takes long.
bool mayHaveGaps(const Scene& world) {
  int parts = 0;
  bool has_plane = false;
  forSurfaces(world, [&](const LevelSurface& surface) {
    if (!isAtFloor(world.floor, surface)) return;
    ++parts;
    has_plane = has_plane || surface.is_plane;
  });
  const FloorExtent& extent = world.floor.extent;
  const double cell = world.settings.grid_spacing;
  const double cells =
      (extent.max_x - extent.min_x) * (extent.max_y - extent.min_y) / (cell * cell);
  return !has_plane && parts > 0 && cells <= kMostCells;
}

void warnOfGaps(const Scene& world, EventLog& log, const FloorCover& cover) {
  const std::optional<PathPoint> gap = findGap(world, cover);
  if (!gap) return;
  std::ostringstream text;
  text << "the floor has a gap beside (" << gap->x << ", " << gap->y
       << "): robots that are sent over a gap cross it as if there were floor";
  log.warn("floor gaps", text.str());
}

/// Fits all models to the floor's height. Static models get other low parts; robots and storage
/// units move up or down.
void fitToFloor(ContactView& world) {
  for (const auto& model : world.models) {
    if (!model || !model->isStatic() || !model->in_physics) continue;
    world.physics.remove(model->bodies);
    model->bodies = model->owner->build(world, *model);
    world.physics.insert(model->bodies);
    refitGeometry(world, *model);
  }
  for (StorageUnit& unit : world.storage.units) {
    Model& model = *world.models[unit.model];
    if (unit.carrier < 0 && !model.disturbed) raiseToFloor(world, &unit, &model);
    moved(world, model);
  }
  for (int robot = 0; robot < world.fleet.size(); ++robot) {
    rebuildBody(world, world.models.of(world.fleet.robots[robot]));
    moved(world, world.models.of(world.fleet.robots[robot]));
  }
}

}  // namespace

void measureFloor(ModelView& world) {
  const double before = world.floor.extent.z;
  const auto height = floorHeight(world);
  world.floor.extent = FloorExtent();
  world.floor.friction = 1;
  world.floor.cover_due = true;
  if (height) {
    world.floor.extent = {1e300, -1e300, 1e300, -1e300, *height};
    double most = -1;
    forSurfaces(world, [&](const LevelSurface& surface) {
      if (!isAtFloor(world.floor, surface)) return;
      widen(&world.floor.extent, surface);
      const double area = extentAt(*height, surface);
      if (area <= most) return;
      most = area;
      world.floor.friction = surface.friction;
    });
  }
  letAllTip(world);
  if (world.floor.extent.z != before) fitToFloor(world);
}

void findFloorParts(const Scene& world, FloorState& floor, EventLog& log) {
  if (!floor.cover_due) return;
  floor.cover_due = false;
  double holds = 0;  // best grip of all wheels on a perfect floor
  for (const Robot& robot : world.fleet.robots) holds = std::max(holds, robot.drive.friction);
  const double usual = std::min(holds, floor.friction);
  if (holds > 0 && usual < kLeastGrip) warnOfSlipperyFloor(log, usual);
  warnOfBumps(world, log);
  bool is_alike = true;
  forSurfaces(world, [&](const LevelSurface& surface) {
    const bool differs = std::min(holds, surface.friction) != usual;
    if (differs && isAtFloor(floor, surface)) is_alike = false;
  });
  floor.cover = nullptr;
  const bool is_searched = mayHaveGaps(world);
  if (is_alike && !is_searched) return;
  const auto cover = std::make_shared<const FloorCover>(world);
  if (is_searched) warnOfGaps(world, log, *cover);
  if (!is_alike) floor.cover = cover;
}

}  // namespace kiva
