// SPDX-License-Identifier: Apache-2.0
#include "core/models/floors.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "core/contact/activation.h"
#include "core/contact/upright.h"
#include "core/state/floors.h"
#include "core/state/footprints.h"

namespace kiva {
namespace {

void widen(Floor* floor, const LevelSurface& surface) {
  floor->min_x = std::min(floor->min_x, surface.min_x);
  floor->max_x = std::max(floor->max_x, surface.max_x);
  floor->min_y = std::min(floor->min_y, surface.min_y);
  floor->max_y = std::max(floor->max_y, surface.max_y);
}

/// Calls visit(model, surface) for the level surfaces of all that stands.
template <typename Visit>
void forSurfaces(const WorldState& world, Visit visit) {
  for (const auto& model : world.models) {
    if (!model) continue;
    for (const LevelSurface& surface : model->level_surfaces) visit(surface);
  }
}

/// The height of the largest surface. Of two about as large, the undersides of slabs for one, the
/// upper one.
std::optional<double> floorHeight(const WorldState& world) {
  std::optional<double> plane;
  std::map<long long, std::pair<double, double>> bounded;  // by height: area, height
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
  for (const auto& [step, found] : bounded) {
    if (!plane || found.second > *plane) most = std::max(most, found.first);
  }
  std::optional<double> height = plane;
  for (const auto& [step, found] : bounded) {
    if (found.first >= most / 2 && (!plane || found.second > *plane)) height = found.second;
  }
  return height;
}

/// Static models have other low parts, robots and storage units stand higher or lower.
void fitToFloor(WorldState& world) {
  for (const auto& model : world.models) {
    if (!model || !model->isStatic() || !model->in_physics) continue;
    world.physics.remove(model->bodies);
    model->bodies = model->owner->build(world, *model);
    world.physics.insert(model->bodies);
    refitGeometry(world, *model);
  }
  for (StorageUnit& unit : world.units) {
    Model& model = *world.models[unit.model];
    if (unit.carrier < 0 && !model.disturbed) raiseToFloor(world, &unit, &model);
    moved(world, model);
  }
  for (int robot = 0; robot < world.fleet.size(); ++robot) {
    rebuildBody(world, world.modelOf(robot));
    moved(world, world.modelOf(robot));
  }
}

}  // namespace

void measureFloor(WorldState& world) {
  const double before = world.floor.z;
  const auto height = floorHeight(world);
  world.floor = Floor();
  world.floor_friction = 1;
  if (height) {
    world.floor = {1e300, -1e300, 1e300, -1e300, *height};
    double nearest = kStep;
    forSurfaces(world, [&](const LevelSurface& surface) {
      const double step = std::abs(surface.z - *height);
      if (step > kStep + 1e-9) return;
      widen(&world.floor, surface);
      if (step > nearest) return;
      nearest = step;
      world.floor_friction = surface.friction;
    });
  }
  letAllTip(world);
  if (world.floor.z != before) fitToFloor(world);
}

}  // namespace kiva
