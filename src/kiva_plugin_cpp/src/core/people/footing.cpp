// SPDX-License-Identifier: Apache-2.0
#include "core/people/footing.h"

#include <algorithm>
#include <cmath>

#include "core/state/places/footprints.h"

namespace kiva {
namespace {

constexpr double kFromRobots = 0.1;   // [m] of clearance that people keep from robots
constexpr double kFromOthers = 0.05;  // [m] of clearance that people keep from all else
constexpr double kFar = 1;            // [m] beyond which distances do not matter

Footprint discOf(const ModelTable& models, const Walker& walker, double x, double y) {
  Footprint disc = circleAt(x, y, walker.radius);
  const double origin = models[walker.model]->pose.Z();
  disc.z_min = origin + walker.bottom;
  disc.z_max = origin + walker.top;
  return disc;
}

}  // namespace

double clearanceAt(const Scene& world, const Walker& walker, double x, double y) {
  const Footprint disc = discOf(world.models, walker, x, y);
  double least = kFar;
  const auto other = [&](const Footprint& thing) {
    if (thing.model == walker.model || !shareHeight(thing, disc)) return false;
    if (mayBeWithin(least + kFromOthers, disc, thing)) {
      least = std::min(least, gap(disc, thing) - kFromOthers);
    }
    return false;
  };
  const auto robot = [&](int i, double radius) {
    const double between = std::hypot(world.fleet.x[i] - x, world.fleet.y[i] - y);
    least = std::min(least, between - radius - walker.radius - kFromRobots);
    return false;
  };
  world.obstacles.any(x, y, walker.radius + kFar, other, robot);
  return least;
}

}  // namespace kiva
