// SPDX-License-Identifier: Apache-2.0
#include "plugins/lift.h"

#include <cmath>

#include "core/contact/activation.h"
#include "core/models/load.h"
#include "core/state/poses.h"
#include "core/state/tasks.h"
#include "core/state/unit_geometry.h"

namespace kiva {
namespace {

/// Moves the tower towards `height` by one step. The whole stroke from rest to rest takes
/// lift.time: half of it at 4·height/time², half at minus that.
void moveTower(WorldState& world, int i, double height) {
  Robot& r = world.fleet.robots[i];
  const double time = r.lift.time;
  const double acceleration = time == 0 ? 0 : 4 * r.lift.height / (time * time);
  const double top = time == 0 ? r.lift.height / world.dt : 2 * r.lift.height / time;
  Profile profile = world.fleet.profile(i);
  profile.advance(height, top, acceleration, acceleration, world.dt);
  world.fleet.setProfile(i, profile);
  world.fleet.tower[i] = profile.position;
}

void begin(WorldState& world, int i) {
  world.fleet.tasks[i].phase = Phase::kLifting;
  world.fleet.setProfile(i, {world.fleet.tower[i], 0});
}

void giveUp(WorldState& world, int i, const std::string& by, const std::string& reason) {
  stopTask(world, i, Phase::kAbandoning, by, reason);
}

/// Gives the lift up if the unit is not, or no longer, where the tower is to meet or leave it.
void checkUnit(WorldState& world, int i, const MotionSegment& segment) {
  if (segment.unit < 0) return giveUp(world, i, "", "the storage unit was deleted");
  if (world.fleet.unit[i] == segment.unit) return;
  const StorageUnit& unit = world.units[segment.unit];
  const bool above = unitDistance(world, i, segment.unit) <= world.fleet.robots[i].lift.proximity &&
                     standsUpright(world, segment.unit);
  if (segment.kind == MotionSegment::Kind::kRaise && unit.carrier >= 0) {
    giveUp(world, i, unit.name, unit.name + " is carried by another robot");
  } else if (segment.kind == MotionSegment::Kind::kRaise && !above) {
    giveUp(world, i, unit.name, unit.name + " is no longer above it");
  } else if (segment.kind == MotionSegment::Kind::kLower &&
             world.fleet.tower[i] > towerGap(world, i, segment.unit)) {
    giveUp(world, i, unit.name, unit.name + " was taken off it");
  }
}

/// The tower comes down without a unit, then the command ends in BLOCKED.
void abandon(WorldState& world, int i) {
  moveTower(world, i, 0);
  if (world.fleet.tower[i] == 0) endStop(world, i);
}

void raiseSegment(WorldState& world, int i, int unit) {
  Robot& r = world.fleet.robots[i];
  moveTower(world, i, r.lift.height);
  if (world.fleet.unit[i] < 0 && world.fleet.tower[i] >= towerGap(world, i, unit)) {
    takeUp(world, i, unit);
  }
  if (world.fleet.reference[i] != r.lift.height) return;
  rebuildBody(world, world.modelOf(i));  // its load is higher than when it was taken up
  world.reportCommand(Event::Kind::kLifted, i, world.units[unit].name,
                      "lifted " + world.units[unit].name);
  finishSegment(world, i);
}

void lowerSegment(WorldState& world, int i, int unit) {
  moveTower(world, i, 0);
  if (world.fleet.unit[i] == unit && unitPose(world, unit).Z() <= 0) {
    putDown(world, i);
    world.reportCommand(Event::Kind::kDropped, i, world.units[unit].name,
                        "dropped " + world.units[unit].name);
  }
  if (world.fleet.tower[i] == 0) finishSegment(world, i);
}

void liftSegment(WorldState& world, int i) {
  const Task& task = world.fleet.tasks[i];
  const MotionSegment segment = task.segments.front();
  if (task.phase == Phase::kStarting) begin(world, i);
  checkUnit(world, i, segment);
  if (task.phase == Phase::kAbandoning) return abandon(world, i);
  if (segment.kind == MotionSegment::Kind::kRaise) raiseSegment(world, i, segment.unit);
  if (segment.kind == MotionSegment::Kind::kLower) lowerSegment(world, i, segment.unit);
}

/// A tower whose unit was deleted comes down by itself.
void lowerEmptyTower(WorldState& world, int i) {
  FleetState& f = world.fleet;
  if (f.reference[i] != f.tower[i]) f.setProfile(i, {f.tower[i], 0});
  moveTower(world, i, 0);
}

}  // namespace

void LiftPlugin::configure(Robot& robot, const Parameters& p) const {
  LiftParameters& lift = robot.lift;
  lift.fitted = true;
  lift.height = p.number("height", lift.height, 0.001, 10);
  lift.time = p.number("time", lift.time, 0, 1000);
  lift.max_load = p.number("max_load", lift.max_load, 0, 1e6);
  lift.proximity = p.number("proximity", lift.proximity, 0, 10);
}

void LiftPlugin::control(WorldState& world) const {
  const FleetState& f = world.fleet;
  for (int i : world.stepped_singly) {
    const MotionSegment* at = f.tasks[i].segment();
    if (!at && f.tower[i] > 0 && f.unit[i] < 0) lowerEmptyTower(world, i);
    if (!at) continue;
    if (at->kind == MotionSegment::Kind::kRaise || at->kind == MotionSegment::Kind::kLower) {
      liftSegment(world, i);
    }
  }
}

}  // namespace kiva
