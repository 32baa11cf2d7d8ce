// SPDX-License-Identifier: Apache-2.0
#include "lift.h"

#include <cmath>

#include "../core/commands.h"
#include "../core/engagement.h"
#include "../core/load.h"

namespace kiva {
namespace {

/// Moves the tower towards `height` by one step. The whole stroke from rest to rest takes
/// lift.time: half of it at 4·height/time², half at minus that.
void moveTower(Parts& parts, int i, double height) {
  Robot& r = parts.fleet.robots[i];
  const double time = r.lift.time;
  const double acceleration = time == 0 ? 0 : 4 * r.lift.height / (time * time);
  const double top = time == 0 ? r.lift.height / parts.dt : 2 * r.lift.height / time;
  Profile profile = parts.fleet.profile(i);
  profile.advance(height, top, acceleration, acceleration, parts.dt);
  parts.fleet.setProfile(i, profile);
  parts.fleet.tower[i] = profile.position;
}

void start(Parts& parts, int i) {
  parts.fleet.robots[i].leg_started = true;
  parts.fleet.setProfile(i, {parts.fleet.tower[i], 0});
}

/// Gives the lift up if the unit is not, or no longer, where the tower is to meet or leave it.
void checkUnit(Parts& parts, int i, const Leg& leg) {
  if (leg.unit < 0) return markBlocked(parts, i, "", "the storage unit was deleted");
  if (parts.fleet.unit[i] == leg.unit) return;
  const StorageUnit& unit = parts.units[leg.unit];
  const bool above = unitDistance(parts, i, leg.unit) <= parts.fleet.robots[i].lift.proximity &&
                     standsUpright(parts, leg.unit);
  if (leg.kind == Leg::Kind::kRaise && unit.carrier >= 0) {
    markBlocked(parts, i, unit.name, unit.name + " is carried by another robot");
  } else if (leg.kind == Leg::Kind::kRaise && !above) {
    markBlocked(parts, i, unit.name, unit.name + " is no longer above it");
  } else if (leg.kind == Leg::Kind::kLower && parts.fleet.tower[i] > towerGap(parts, i, leg.unit)) {
    markBlocked(parts, i, unit.name, unit.name + " was taken off it");
  }
}

/// The tower comes down without a unit, then the command ends in BLOCKED.
void abandon(Parts& parts, int i) {
  moveTower(parts, i, 0);
  if (parts.fleet.tower[i] == 0) endBlocked(parts, i);
}

void raiseLeg(Parts& parts, int i, int unit) {
  Robot& r = parts.fleet.robots[i];
  moveTower(parts, i, r.lift.height);
  if (parts.fleet.unit[i] < 0 && parts.fleet.tower[i] >= towerGap(parts, i, unit)) {
    takeUp(parts, i, unit);
  }
  if (parts.fleet.reference[i] != r.lift.height) return;
  rebuildBody(parts, i);  // its load is higher than when it was taken up
  parts.report(Event::Kind::kLifted, r.name, parts.units[unit].name, "");
  finishLeg(parts, i);
}

void lowerLeg(Parts& parts, int i, int unit) {
  moveTower(parts, i, 0);
  if (parts.fleet.unit[i] == unit && unitPose(parts, unit).Z() <= 0) {
    putDown(parts, i);
    parts.report(Event::Kind::kDropped, parts.fleet.robots[i].name, parts.units[unit].name, "");
  }
  if (parts.fleet.tower[i] == 0) finishLeg(parts, i);
}

void liftLeg(Parts& parts, int i) {
  const Leg leg = parts.fleet.robots[i].legs.front();
  if (!parts.fleet.robots[i].leg_started) start(parts, i);
  checkUnit(parts, i, leg);
  if (parts.fleet.robots[i].stopping) return abandon(parts, i);
  if (leg.kind == Leg::Kind::kRaise) raiseLeg(parts, i, leg.unit);
  if (leg.kind == Leg::Kind::kLower) lowerLeg(parts, i, leg.unit);
}

/// A tower whose unit was deleted comes down by itself.
void lowerEmptyTower(Parts& parts, int i) {
  Fleet& f = parts.fleet;
  if (f.reference[i] != f.tower[i]) f.setProfile(i, {f.tower[i], 0});
  moveTower(parts, i, 0);
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

void LiftPlugin::beforeStep(Parts& parts) {
  const Fleet& f = parts.fleet;
  for (int i : parts.active) {
    if (!f.robots[i].legs.empty()) {
      const Leg::Kind kind = f.robots[i].legs.front().kind;
      if (kind == Leg::Kind::kRaise || kind == Leg::Kind::kLower) liftLeg(parts, i);
    } else if (f.tower[i] > 0 && f.unit[i] < 0) {
      lowerEmptyTower(parts, i);
    }
  }
}

}  // namespace kiva
