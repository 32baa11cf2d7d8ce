// SPDX-License-Identifier: Apache-2.0
#include "core/sensing/room.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/state/places/footprints.h"

namespace kiva {
namespace {

constexpr double kLaneMargin = 0.005;  // [m] on each side of a robot that drives on
// Step of a simulated turn [rad]. A model counts as touched if it comes nearer by more than this in
// a step [m]: between two steps a corner passes another by at most that.
constexpr double kTurnStep = M_PI / 360;
constexpr double kTouch = 0.001;
constexpr double kFine = 1e-3;    // [rad], precision of its end
constexpr double kNearer = 1e-6;  // [m]

/// Returns whether it is part of a storage unit that no robot carries.
bool isOfUnit(const Scene& world, const Footprint& other) {
  const Model& model = *world.models[other.model];
  return model.kind == ModelKind::kStorageUnit && world.storage.units[model.index].carrier < 0;
}

Footprint turningCircle(const FleetState& fleet, int robot, double x, double y) {
  return circleAt(x, y, cornerRadius(fleet.robots[robot]));
}

double gapTo(const std::vector<Footprint>& all, const Footprint& other) {
  double least = 1e9;
  for (const Footprint& own : all) {
    if (shareHeight(own, other)) least = std::min(least, gap(own, other));
  }
  return least;
}

/// Returns the model to which the robot comes too near from `before` to `then`; -1 = none.
int touchedBy(const std::vector<Footprint>& then, const std::vector<Footprint>& before,
              const std::vector<Footprint>& things) {
  for (const Footprint& thing : things) {
    const double distance = gapTo(then, thing);
    if (distance < kTouch && distance < gapTo(before, thing) - kNearer) return thing.model;
  }
  return -1;
}

/// Returns the footprints within reach of the robot's corners, or of its load's.
std::vector<Footprint> thingsAround(const Scene& world, int robot, double x, double y,
                                    Among among) {
  std::vector<Footprint> things;
  const Footprint circle = turningCircle(world.fleet, robot, x, y);
  const double top = world.floor.extent.z + heightOf(world.fleet, robot);
  world.obstacles.near(x, y, circle.hx, [&](const Footprint& other) {
    if (other.group == robot || other.z_min >= top || gap(circle, other) > 0) return;
    const Model& model = *world.models[other.model];
    const bool counts =
        isOfUnit(world, other) || (among == Among::kAll && model.owner->stops(world, model, robot));
    if (counts) things.push_back(other);
  });
  return things;
}

/// Returns the area that the robot covers while it drives that distance from a pose.
Footprint lane(const Scene& world, int robot, const PlanarPose& from, double way, double margin) {
  const Robot& r = world.fleet.robots[robot];
  Footprint out;
  out.c = std::cos(from.yaw);
  out.s = std::sin(from.yaw);
  out.hx = (std::abs(way) + halfLength(r)) / 2;
  out.hy = halfWidth(r) + margin;
  const double middle = std::copysign(out.hx, way);
  out.x = from.x + out.c * middle;
  out.y = from.y + out.s * middle;
  out.z_min = world.floor.extent.z;
  out.z_max = world.floor.extent.z + heightOf(world.fleet, robot);
  return out;
}

/// Returns the robot's pose if it were on the line of its segment.
PlanarPose onLine(const FleetState& f, int robot) {
  const MotionSegment& segment = f.tasks[robot].segments.front();
  const PlanarPose at = f.believed(robot);
  const double across =
      std::cos(segment.yaw) * (at.y - segment.y) - std::sin(segment.yaw) * (at.x - segment.x);
  const double yaw = f.yaw[robot] - (at.yaw - segment.yaw);
  return {f.x[robot] + across * std::sin(yaw), f.y[robot] - across * std::cos(yaw), yaw};
}

}  // namespace

bool isFree(const Scene& world, int robot, double x, double y) {
  const Footprint disc = turningCircle(world.fleet, robot, x, y);
  bool is_free = true;
  world.obstacles.near(x, y, disc.hx, [&](const Footprint& other) {
    if (!is_free || other.group == robot || gap(disc, other) > 0) return;
    const Model& model = *world.models[other.model];
    is_free = !model.owner->stops(world, model, robot);
  });
  return is_free;
}

bool standsInLane(const Scene& world, const Model& unit, int robot) {
  const FleetState& f = world.fleet;
  const double reach = f.robots[robot].laser.max_range;
  const Footprint swept = lane(world, robot, onLine(f, robot), reach, kLaneMargin);
  return std::any_of(unit.geometries.begin(), unit.geometries.end(),
                     [&](const CollisionGeometry& geometry) {
                       if (geometry.handle < 0) return false;
                       const Footprint& leg = world.obstacles[geometry.handle];
                       return shareHeight(swept, leg) && gap(swept, leg) < 0;
                     });
}

TurnRoom roomToTurn(const Scene& world, int robot, const PlanarPose& at, Among among) {
  TurnRoom room;
  const std::vector<Footprint> things = thingsAround(world, robot, at.x, at.y, among);
  if (things.empty()) return room;
  const std::vector<Footprint>& local = world.obstacles.ofMover(robot);
  std::vector<Footprint> now = local, then = local;
  placeAll(local, at.x, at.y, at.yaw, &now);
  const auto touchedAt = [&](double by) {
    placeAll(local, at.x, at.y, at.yaw + by, &then);
    return touchedBy(then, now, things);
  };
  const auto turn = [&](double step, double* end, int* touched) {
    double by = step;
    for (; *touched < 0 && std::abs(by) < 2 * M_PI; by += step) *touched = touchedAt(by);
    if (*touched < 0) return;
    double free = by - 2 * step;
    for (double more = step / 2; std::abs(more) > kFine; more /= 2) {
      if (touchedAt(free + more) < 0) free += more;
    }
    *end = at.yaw + free + std::copysign(kFine, step);
  };
  turn(-kTurnStep, &room.least, &room.at_least);
  turn(kTurnStep, &room.most, &room.at_most);
  return room;
}

bool hasRoomToTurn(const Scene& world, int robot, double x, double y) {
  return thingsAround(world, robot, x, y, Among::kAll).empty();
}

bool isWayFree(const Scene& world, int robot, const PlanarPose& from, double way, double margin) {
  const Footprint swept = lane(world, robot, from, way, margin);
  bool is_free = true;
  world.obstacles.near(swept.x, swept.y, radiusOf(swept), [&](const Footprint& other) {
    if (!is_free || !shareHeight(swept, other) || gap(swept, other) > 0) return;
    is_free = !isOfUnit(world, other);
  });
  return is_free;
}

}  // namespace kiva
