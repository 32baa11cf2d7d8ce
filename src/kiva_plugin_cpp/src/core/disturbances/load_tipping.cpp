// SPDX-License-Identifier: Apache-2.0
#include "core/disturbances/load_tipping.h"

#include <algorithm>
#include <cmath>

#include "core/models/models.h"
#include "core/state/places/poses.h"
#include "core/state/progress/tasks.h"

namespace kiva {
namespace {

constexpr double kTips = 0.1;  // [rad] of tilt from which Bullet steps the load

/// Returns the angular acceleration about the edge towards which the load leans [rad/s²]: that of a
/// rigid body on an accelerated base.
double tiltAcceleration(const Robot& r, double gravity, double tilt, double pushed) {
  const double h = r.load_height, d = r.load_foothold, c = std::cos(tilt), s = std::sin(tilt);
  const double torque = pushed * (h * c + d * s) - gravity * (d * c - h * s);
  return r.load_mass * torque / r.load_tipping_inertia;
}

/// Tilts the load against the acceleration of its feet.
void lean(Sway* sway, const Robot& r, double gravity, double ax, double ay, double dt) {
  if (sway->tilt == 0) {
    const double size = std::hypot(ax, ay);
    if (size * r.load_height <= gravity * r.load_foothold) return;
    sway->to_x = -ax / size;
    sway->to_y = -ay / size;
  }
  const double pushed = -(ax * sway->to_x + ay * sway->to_y);
  sway->rate += tiltAcceleration(r, gravity, sway->tilt, pushed) * dt;
  sway->tilt += sway->rate * dt;
  if (sway->tilt > 0) return;
  sway->tilt = sway->rate = 0;
}

/// Passes the load to Bullet with its tilt about the edge of the plate, and its rate.
void tipOff(ModelView& world, int robot) {
  FleetState& f = world.fleet;
  const Sway sway = f.sway[robot];
  f.sway[robot] = {};
  Model& unit = *world.models[world.storage.units[f.unit[robot]].model];
  const Pose pose = unitPose(world, f.unit[robot]), plate = towerPose(world, robot);
  const Vector3 axis(-sway.to_y, sway.to_x, 0);
  const Quaternion turn(axis, sway.tilt);
  const double reach = f.robots[robot].load_foothold;
  const Vector3 edge = plate.Pos() + Vector3(sway.to_x, sway.to_y, 0) * reach;
  EntityState state;
  state.pose = Pose(edge + turn * (pose.Pos() - edge), turn * pose.Rot());
  state.twist.angular = axis * sway.rate;
  state.twist.linear =
      Vector3(f.vx[robot], f.vy[robot], 0) + state.twist.angular.Cross(state.pose.Pos() - edge);
  world.log.report(Event::Kind::kTipped, unit.name, f.robots[robot].name,
                   unit.name + " tips off " + f.robots[robot].name);
  placeModel(world, unit, state);
  haltRobot(world, robot, unit.name, "has lost its load");
}

/// Drops a load whose centre of mass is no longer above the plate, since items were added or
/// removed.
void dropOverhung(ModelView& world, int robot) {
  FleetState& f = world.fleet;
  const double* centre = f.robots[robot].load_centre;
  const double off = std::hypot(centre[0], centre[1]);
  const double c = std::cos(f.yaw[robot]), s = std::sin(f.yaw[robot]);
  f.sway[robot].to_x = (c * centre[0] - s * centre[1]) / off;
  f.sway[robot].to_y = (s * centre[0] + c * centre[1]) / off;
  tipOff(world, robot);
}

void stepOne(ModelView& world, int robot) {
  FleetState& f = world.fleet;
  Sway& sway = f.sway[robot];
  const double ax = (f.vx[robot] - sway.vx) / world.clock.dt,
               ay = (f.vy[robot] - sway.vy) / world.clock.dt;
  const bool is_next = sway.step + 1 == world.clock.total_steps;
  sway.vx = f.vx[robot];
  sway.vy = f.vy[robot];
  sway.step = world.clock.total_steps;
  if (!is_next) return;  // the robot stood or cruised
  lean(&sway, f.robots[robot], world.settings.gravityDown(), ax, ay, world.clock.dt);
  if (sway.tilt > kTips) tipOff(world, robot);
}

}  // namespace

void stepLoadTipping(ModelView& world) {
  const bool leans = world.settings.realism.loads.enabled;
  const std::vector<int> stepped =
      world.schedule.stepped_singly;  // a robot that loses its load may be deleted then
  for (const int robot : stepped) {
    if (robot >= world.fleet.size() || world.fleet.unit[robot] < 0) continue;
    if (world.fleet.robots[robot].load_foothold <= 0) {
      dropOverhung(world, robot);
    } else if (leans) {
      stepOne(world, robot);
    }
  }
}

}  // namespace kiva
