// SPDX-License-Identifier: Apache-2.0
#include "core/sensing/look_ahead.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "core/parallel/workers.h"
#include "core/sensing/arc_look.h"
#include "core/sensing/room.h"
#include "core/sensing/scans.h"
#include "core/state/places/footprints.h"
#include "core/state/progress/path_progress.h"

namespace kiva {
namespace {

// Margin of the corridor on each side of the robot. A loaded robot that turns in the next lane
// reaches to 1 − 0.566 m, which must stay outside.
constexpr double kSideMargin = 0.03;  // [m]
// Margin to models that stand or turn beyond a path's released end. A loaded robot that turns in
// the next cell comes as near as 1 − 0.566 − 0.4 m.
constexpr double kEndMargin = 0.02;  // [m]
constexpr int kLooksTogether = 16;   // on one thread
constexpr double kFlat = 0.02;       // [m], largest difference of adjacent rays on a face

/// Returns the margin at a path's end, less the noise by which an obstacle may seem nearer.
double endMargin(const WorldSettings& settings) {
  const LaserRealism& real = settings.realism.lasers;
  return real.enabled ? std::max(0.0, kEndMargin - 3 * real.range_noise) : kEndMargin;
}

/// Returns whether the model stops the robot: a robot can't pass beneath a unit that stands askew.
bool stops(const Scene& world, int model, int robot) {
  const Model& other = *world.models[model];
  if (other.owner->stops(world, other, robot)) return true;
  return other.kind == ModelKind::kStorageUnit && standsInLane(world, other, robot);
}

/// Returns the nearest obstacle in the corridor that the robot would sweep.
Sighting sightingOf(const Scene& world, const Scans& scans, int robot) {
  const Robot& r = world.fleet.robots[robot];
  const RayFan& fan = scans.fans[r.ray_fan];
  const double half = halfWidth(r) + kSideMargin;
  static thread_local FanHits hits;
  Sighting sighting;
  sighting.taken = true;
  sighting.along = alongSegment(world.fleet, robot);
  const double reach = reachOfInterest(world, robot) - sighting.along - r.laser.x;
  const double farthest = std::min(r.laser.max_range, lengthOf(std::max(0.0, reach), half));
  // A ray matters until it leaves the corridor.
  castRays(world, scans, robot, {farthest, half}, &hits);
  sighting.distance = std::numeric_limits<double>::infinity();
  int before = -1;  // model that the previous ray met
  double before_distance = 0;
  int stopping = -1, passed = -1;  // models for which the answer is known
  for (int ray = hits.first; ray <= hits.last; ++ray) {
    int model = static_cast<int>(hits.model[ray]);
    if (model >= 0 && model != stopping) {
      if (model != passed) (stops(world, model, robot) ? stopping : passed) = model;
      if (model != stopping) model = -1;
    }
    const double distance = r.laser.x + hits.range[ray] * fan.c[ray];
    const bool faces =
        model >= 0 && model == before && std::abs(distance - before_distance) < kFlat;
    if (model >= 0 && distance < sighting.distance) {
      sighting.distance = distance;
      sighting.model = model;
      sighting.faces = faces;
    } else if (faces && before_distance == sighting.distance) {
      sighting.faces = true;
    }
    before = model;
    before_distance = distance;
  }
  return sighting;
}

bool isOnGuard(const FleetState& f, int robot) {
  const Task& task = f.tasks[robot];
  const bool is_blind = (f.failures[robot] & bitOf(Failure::kLaser)) != 0;
  return f.robots[robot].laser.fitted && !is_blind && (task.drives() || task.isHeldUp()) &&
         !task.segments.front().reverse;
}

/// Looks ahead of those of `robots` that drive and watch their way.
void lookAhead(RobotView& world, Scans& scans, const std::vector<int>& robots) {
  FleetState& f = world.fleet;
  std::vector<char> looked(robots.size(), 0);
  const auto count = static_cast<int>(robots.size());
  world.schedule.workers->share(count, kLooksTogether, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) {
      fetchTasksAhead(f, robots, k);
      if (looksAlongArc(f, robots[k])) lookAlongArc(world, scans, robots[k]);
      if (!isOnGuard(f, robots[k])) continue;
      looked[k] = 1;
      Task& task = f.tasks[robots[k]];
      task.last_sighting = task.sighting;
      task.sighting = sightingOf(world, scans, robots[k]);
    }
  });
  for (int k = 0; k < count; ++k) {
    if (looked[k]) scans.sighted.push_back(robots[k]);
  }
}

/// Returns the robots that have begun to drive, or are asked for another way: they look at once.
std::vector<int> beginners(const Scene& world) {
  const FleetState& f = world.fleet;
  std::vector<int> out;
  for (int i : world.schedule.stepped_singly) {
    const bool begins = isOnGuard(f, i) && !f.tasks[i].sighting.taken;
    if (begins || (looksAlongArc(f, i) && f.steering(i).looks)) out.push_back(i);
  }
  return out;
}

}  // namespace

void lookAhead(RobotView& world, Scans& scans) {
  scans.sighted.clear();
  lookAhead(world, scans, scans.due);
  lookAhead(world, scans, beginners(world));
}

double reachOfInterest(const Scene& world, int robot) {
  const Task& task = world.fleet.tasks[robot];
  const MotionSegment& segment = task.segments.front();
  if (!task.follows() || !segment.on_grid) return std::numeric_limits<double>::infinity();
  return segment.length + halfLength(world.fleet.robots[robot]) + endMargin(world.settings);
}

}  // namespace kiva
