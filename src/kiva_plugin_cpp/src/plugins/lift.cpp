// SPDX-License-Identifier: Apache-2.0
#include "plugins/lift.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "core/contact/activation.h"
#include "core/models/load.h"
#include "core/state/places/footprints.h"
#include "core/state/places/poses.h"
#include "core/state/places/unit_geometry.h"
#include "core/state/progress/tasks.h"

namespace kiva {
namespace {

constexpr double kStalled = 0.5;  // [s] at the largest force before the lift gives up
constexpr double kSpareForce =
    1.25;  // force as a multiple of the largest load's weight, unless the robot's file has one
constexpr double kBeside = 0.001;  // [m] of overlap up to which outlines count as side by side

/// The next obstacle above a load that rises.
struct Above {
  double clearance = 1e9;  // [m]
  int model = -1;
};

/// Returns whether `other` hangs above `own`, or into its upper half.
bool isAbove(const Footprint& own, const Footprint& other) {
  return other.z_min > (own.z_min + own.z_max) / 2 && mayBeWithin(0, own, other) &&
         gap(own, other) < -kBeside;
}

Above findAbove(const Scene& world, int i) {
  Above above;
  const Fleet& f = world.fleet;
  const std::vector<Footprint>& all = world.obstacles.footprints(i);
  double lowest = 1e9;  // middle of a footprint: what hangs above one is above it
  for (const Footprint& own : all) lowest = std::min(lowest, (own.z_min + own.z_max) / 2);
  world.obstacles.near(f.x[i], f.y[i], world.obstacles.radius(i), [&](const Footprint& other) {
    if (other.group == i || other.z_min <= lowest) return;
    for (const Footprint& own : all) {
      const double clearance = std::max(0.0, other.z_min - own.z_max);
      if (clearance < above.clearance && isAbove(own, other)) above = {clearance, other.model};
    }
  });
  return above;
}

/// Returns the force with which a model resists being lifted [N]: its weight, unless it is fixed or
/// a robot, whose wheels stay on the floor.
double resistance(const Scene& world, const Model& model) {
  if (model.isStatic() || model.owner->robot(world, model) >= 0) return 1e16;
  double mass = 0;
  for (const Link& link : model.description->links) mass += link.mass;
  return mass * world.settings.gravityDown();
}

void setTower(TaskView& world, Obstacles& obstacles, int i, double height) {
  raiseLoad(world.fleet, obstacles, world.storage, i, height - world.fleet.tower[i]);
  world.fleet.tower[i] = height;
}

/// Moves the tower towards `height` by one step. The whole stroke from rest to rest takes
/// lift.time: 4·height/time² in its first half, minus that in its second.
void moveTower(TaskView& world, Obstacles& obstacles, int i, double height) {
  Robot& r = world.fleet.robots[i];
  const double time = r.lift.time;
  const double acceleration = time == 0 ? 0 : 4 * r.lift.height / (time * time);
  const double top = time == 0 ? r.lift.height / world.clock.dt : 2 * r.lift.height / time;
  Profile profile = world.fleet.profile(i);
  profile.advance(height, top, acceleration, acceleration, world.clock.dt);
  world.fleet.setProfile(i, profile);
  setTower(world, obstacles, i, profile.position);
}

void begin(RobotView& world, int i) {
  world.fleet.tasks[i].phase = Phase::kLifting;
  world.fleet.setProfile(i, {world.fleet.tower[i], 0});
}

void giveUp(TaskView& world, int i, const std::string& by, const std::string& reason) {
  stopTask(world, i, Phase::kAbandoning, by, reason);
}

/// Gives the lift up if the unit is not, or no longer, at the place of the lift.
void checkUnit(TaskView& world, int i, const MotionSegment& segment) {
  if (segment.unit < 0) return giveUp(world, i, "", "the storage unit was deleted");
  if (world.fleet.unit[i] == segment.unit) return;
  const StorageUnit& unit = world.storage.units[segment.unit];
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

void putDownOnFloor(ContactView& world, int i, int unit) {
  if (unit < 0 || world.fleet.unit[i] != unit) return;
  if (unitPose(world, unit).Z() > world.floor.extent.z) return;
  putDown(world, i);
  reportCommand(world, world.log, Event::Kind::kDropped, i, world.storage.units[unit].name,
                "dropped " + world.storage.units[unit].name);
}

/// Lowers the tower, puts a carried unit on the floor, then ends the command in BLOCKED.
void abandon(ContactView& world, int i, int unit) {
  moveTower(world, world.obstacles, i, 0);
  putDownOnFloor(world, i, unit);
  if (world.fleet.tower[i] == 0) endStop(world, i);
}

/// Holds the tower where its force does not suffice: beneath an obstacle that it can't lift, or
/// under a load that is too heavy. Gives up after kStalled. `above` is the obstacle as seen from
/// the height `before` [m].
void stall(TaskView& world, Obstacles& obstacles, int i, double before, const Above& above) {
  FleetState& f = world.fleet;
  const Robot& r = f.robots[i];
  double& overdue = f.tasks[i].overdue;
  double force = r.load_mass * world.settings.gravityDown();
  const bool meets = f.tower[i] - before > above.clearance;
  if (meets) force += resistance(world, *world.models[above.model]);
  if (force <= r.lift.max_force) {
    overdue = 0;
    return;
  }
  const double height = meets ? before + above.clearance : before;
  f.setProfile(i, {height, 0});
  setTower(world, obstacles, i, height);
  overdue += world.clock.dt;
  if (overdue < kStalled) return;
  const std::string other = meets ? world.models[above.model]->name : "";
  char text[160];
  std::snprintf(text, sizeof text, "its lift stalls at %g N%s%s", r.lift.max_force,
                meets ? " beneath " : ": the load is too heavy", other.c_str());
  giveUp(world, i, other, text);
}

void raiseSegment(ContactView& world, int i, int unit) {
  Robot& r = world.fleet.robots[i];
  const double before = world.fleet.tower[i];
  const bool is_loaded = world.fleet.unit[i] >= 0;
  const Above above = is_loaded ? findAbove(world, i) : Above();
  moveTower(world, world.obstacles, i, r.lift.height);
  if (is_loaded) stall(world, world.obstacles, i, before, above);
  if (world.fleet.unit[i] < 0 && world.fleet.tower[i] >= towerGap(world, i, unit)) {
    takeUp(world, i, unit);
  }
  if (world.fleet.reference[i] != r.lift.height) return;
  rebuildBody(world,
              world.models.of(world.fleet.robots[i]));  // its load is higher than at its taking up
  reportCommand(world, world.log, Event::Kind::kLifted, i, world.storage.units[unit].name,
                "lifted " + world.storage.units[unit].name);
  finishSegment(world, i);
}

void lowerSegment(ContactView& world, int i, int unit) {
  moveTower(world, world.obstacles, i, 0);
  putDownOnFloor(world, i, unit);
  if (world.fleet.tower[i] == 0) finishSegment(world, i);
}

/// Stops the tower and holds it.
void holdTower(TaskView& world, Obstacles& obstacles, int i) {
  FleetState& f = world.fleet;
  if (f.tasks[i].phase == Phase::kStarting || f.reference_speed[i] == 0) return;
  Profile profile = f.profile(i);
  profile.brake(f.robots[i].drive.emergency_deceleration, world.clock.dt, &f.tasks[i].stop_at);
  profile.position = std::clamp(profile.position, 0.0, f.robots[i].lift.height);
  f.setProfile(i, profile);
  setTower(world, obstacles, i, profile.position);
}

void liftSegment(ContactView& world, int i) {
  const Task& task = world.fleet.tasks[i];
  if (isHeld(world.fleet, i)) return holdTower(world, world.obstacles, i);
  const MotionSegment segment = task.segments.front();
  if (task.phase == Phase::kStarting) begin(world, i);
  checkUnit(world, i, segment);
  if (task.phase == Phase::kAbandoning) return abandon(world, i, segment.unit);
  if (segment.kind == MotionSegment::Kind::kRaise) raiseSegment(world, i, segment.unit);
  if (segment.kind == MotionSegment::Kind::kLower) lowerSegment(world, i, segment.unit);
}

/// Lowers a tower whose unit was deleted.
void lowerEmptyTower(TaskView& world, Obstacles& obstacles, int i) {
  FleetState& f = world.fleet;
  if (f.reference[i] != f.tower[i]) f.setProfile(i, {f.tower[i], 0});
  moveTower(world, obstacles, i, 0);
}

}  // namespace

void LiftPlugin::configure(Robot& robot, const Parameters& p) const {
  LiftParameters& lift = robot.lift;
  lift.fitted = true;
  lift.fields(lift, p.reader());
  if (!p.has("max_force")) lift.max_force = kSpareForce * 9.81 * lift.max_load;
}

void LiftPlugin::control(ContactView& world) const {
  const FleetState& f = world.fleet;
  const std::vector<int>& robots = world.schedule.stepped_singly;
  for (std::size_t k = 0; k < robots.size(); ++k) {
    fetchTasksAhead(f, robots, k);
    const int i = robots[k];
    const Task& task = f.tasks[i];
    const bool is_up_empty = f.tower[i] > 0 && f.unit[i] < 0;
    if (!task.segment() && is_up_empty && !isHeld(f, i)) lowerEmptyTower(world, world.obstacles, i);
    if (task.lifts()) liftSegment(world, i);
  }
}

}  // namespace kiva
