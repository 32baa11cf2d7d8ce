// SPDX-License-Identifier: Apache-2.0
#include "core/sensing/arc_look.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/infinity.h"
#include "core/geometry/swept_arc.h"
#include "core/sensing/scans.h"
#include "core/state/places/footprints.h"

namespace kiva {
namespace {

// Margins on each side of the robot, as for drives along the grid: to the legs of a storage unit,
// and to all else.
constexpr double kBesideUnits = 0.005, kBesideOthers = 0.03;  // [m]
constexpr double kStandOff = 0.05;  // [m] to an obstacle at which it stands
constexpr double kSlow = 0.05;      // [m/s] below which the present way does not matter
constexpr double kSameWay = 0.02;   // [1/m], difference of curvatures of one way
constexpr double kApproaches = 0.25, kTopApproach = 3;  // [m/s] of an obstacle that comes nearer

// What is near and beside the heading leaves the laser's view before the robot has passed it. A
// second field sees all that is before the front, as a safety scanner does.
constexpr double kFieldReach = 1;  // [m]
constexpr int kFieldRays = 181;

const RayFan& nearField() {
  static const RayFan fan = fanOf(kFieldRays, -M_PI / 2, M_PI / 2);
  return fan;
}

/// The next obstacle on an arc.
struct Met {
  double way = kInfinity;  // [m]
  int model = -1;
};

double curvatureOf(const DriveVelocity& velocity) { return velocity.turn_rate / velocity.speed; }

/// Returns the margin to a model [m]; negative if it does not stop the robot.
double marginTo(const Scene& world, const Model& model, int robot) {
  if (model.kind == ModelKind::kStorageUnit) return kBesideUnits;
  return model.owner->stops(world, model, robot) ? kBesideOthers : -1;
}

Met nearestOn(double curvature, const Scene& world, const RayFan& fan, const FanHits& hits,
              int robot) {
  const Robot& r = world.fleet.robots[robot];
  Met nearest;
  for (int ray = hits.first; ray <= hits.last; ++ray) {
    const auto model = static_cast<int>(hits.model[ray]);
    if (model < 0) continue;
    const double margin = marginTo(world, *world.models[model], robot);
    if (margin < 0) continue;
    const double range = hits.range[ray];
    const double way = wayToPoint({curvature, halfLength(r), halfWidth(r) + margin},
                                  r.laser.x + range * fan.c[ray], range * fan.s[ray]);
    if (way < nearest.way) nearest = {way, model};
  }
  return nearest;
}

/// Measures the speed at which the obstacle comes nearer by itself, from two looks that are at
/// least `least_time` [s] apart; 0 if it is another one, or on another way.
void measureApproach(const Met& met, double curvature, double least_time, Steering* s) {
  const bool is_same =
      met.model >= 0 && met.model == s->obstacle && std::abs(curvature - s->curvature) < kSameWay;
  if (is_same && s->since_measured < least_time) return;
  const double speed = is_same ? (s->measured - met.way) / s->since_measured : 0;
  s->approach = speed > kApproaches && speed < kTopApproach ? speed : 0;
  s->measured = met.way;
  s->since_measured = 0;
  s->curvature = curvature;
}

}  // namespace

bool looksAlongArc(const FleetState& f, int robot) {
  if (!f.tasks[robot].isSteered() || !f.robots[robot].laser.fitted || isBlind(f, robot)) {
    return false;
  }
  const Steering& s = f.steering(robot);
  return s.asked.speed > 0 || s.command.speed > 0;
}

void lookAlongArc(RobotView& world, const Scans& scans, int robot) {
  static thread_local FanHits hits, near_hits;
  Steering& s = world.fleet.steering(robot);
  const Robot& r = world.fleet.robots[robot];
  castRays(world, scans, robot, {r.laser.max_range, kInfinity}, &hits);
  world.obstacles.cast(nearField(), sensorOf(world, robot), {kFieldReach, kInfinity}, robot,
                       &near_hits);
  Met met;
  const auto look = [&](double curvature) {
    for (const Met& next : {nearestOn(curvature, world, scans.fans[r.ray_fan], hits, robot),
                            nearestOn(curvature, world, nearField(), near_hits, robot)}) {
      if (next.way < met.way) met = next;
    }
  };
  const double curvature = curvatureOf(s.asked.speed > 0 ? s.asked : s.command);
  look(curvature);
  const double present = s.command.speed > kSlow ? curvatureOf(s.command) : curvature;
  if (std::abs(present - curvature) > kSameWay) look(present);
  const double period = static_cast<double>(scanPeriod(world.clock, r)) * world.clock.dt;
  measureApproach(met, curvature, period / 2, &s);
  s.room = std::max(0.0, met.way - kStandOff);
  s.obstacle = met.model;
  s.since_look = 0;
  s.looks = false;
}

}  // namespace kiva
