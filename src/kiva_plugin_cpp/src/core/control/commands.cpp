// SPDX-License-Identifier: Apache-2.0
#include "core/control/commands.h"

#include <cmath>
#include <cstdio>

#include "core/control/interruptions.h"
#include "core/control/paths.h"
#include "core/control/radio.h"
#include "core/control/route.h"
#include "core/state/tasks.h"
#include "core/state/unit_geometry.h"

namespace kiva {
namespace {

constexpr double kLookAgain = 0.5;  // [s] after which a robot looks for a way back again

struct Plan {
  std::deque<MotionSegment> segments;
  std::string text;
  std::string other;
};

double checkedDistance(const WorldState& world, double distance) {
  if (!std::isfinite(distance)) {
    throw Refusal(format("distance %g: a finite number of metres was expected", distance));
  }
  const double whole = nearestGrid(world, distance);
  if (std::abs(whole - distance) <= kGoalTolerance) return whole;
  throw Refusal(format("distance %g m is no whole number of %g m cells", distance,
                       world.settings.grid_spacing));
}

Plan planMoveTo(const WorldState& world, int robot, const Command& command) {
  checkMotion(world, robot);
  const Point goal{checkedGoal(world, command.x, 'x'), checkedGoal(world, command.y, 'y')};
  checkGoal(world, goal);
  Route route(world, robot);
  route.driveTo(0, goal.x);
  route.driveTo(1, goal.y);
  return {route.takeSegments(), format("go to (%g, %g)", goal.x, goal.y), ""};
}

Plan planMoveAlong(const WorldState& world, int robot, int axis, double asked) {
  checkMotion(world, robot);
  const double distance = checkedDistance(world, asked);
  Route route(world, robot);
  Point goal = route.at();
  goal[axis] += distance;
  checkGoal(world, goal);
  route.driveTo(axis, goal[axis]);
  return {route.takeSegments(), format("go %g m along %c", distance, axis == 0 ? 'x' : 'y'), ""};
}

Plan planRotate(const WorldState& world, int robot, int direction) {
  if (direction != 1 && direction != -1) {
    throw Refusal(
        format("direction %d: 1 (counterclockwise) or -1 (clockwise) was expected", direction));
  }
  Route route(world, robot);
  route.rotate(direction);
  return {route.takeSegments(), direction > 0 ? "turn counterclockwise" : "turn clockwise", ""};
}

int findUnit(const WorldState& world, int id) {
  const auto at = world.storage.unit_of_id.find(id);
  if (at == world.storage.unit_of_id.end()) throw Refusal(format("there is no storage_unit%d", id));
  return at->second;
}

void checkCarry(const WorldState& world, int robot, int unit) {
  const Fleet& f = world.fleet;
  const StorageUnit& u = world.storage.units[unit];
  const LiftParameters& lift = f.robots[robot].lift;
  if (f.unit[robot] >= 0) throw Refusal("it carries " + world.storage.units[f.unit[robot]].name);
  const int holder = u.carrier >= 0 ? u.carrier : u.claimed_by;
  if (holder >= 0) throw Refusal(u.name + " is carried by " + f.robots[holder].name);
  const double distance = unitDistance(world, robot, unit);
  if (!(distance <= lift.proximity)) {
    throw Refusal(format("%s is %.3f m away; %g m at the most is close enough", u.name.c_str(),
                         distance, lift.proximity));
  }
  if (!standsUpright(world, unit)) throw Refusal(u.name + " does not stand upright on the floor");
  if (u.mass > lift.max_load) {
    throw Refusal(format("%s weighs %g kg, more than the %g kg it can carry", u.name.c_str(),
                         u.mass, lift.max_load));
  }
  if (towerGap(world, robot, unit) >= lift.height) {
    throw Refusal(
        format("its tower rises %g m, which does not reach %s", lift.height, u.name.c_str()));
  }
}

/// What a drop that names no unit means.
int carriedUnit(const WorldState& world, int robot) {
  const int unit = world.fleet.unit[robot];
  if (unit < 0) throw Refusal("it carries nothing");
  return unit;
}

Plan planLift(const WorldState& world, int robot, const Command& command) {
  if (!world.fleet.robots[robot].lift.fitted) throw Refusal("it has no lift plugin");
  if (command.lift != 0 && command.lift != 1) {
    throw Refusal(format("status %d: 1 (carry) or 0 (drop) was expected", command.lift));
  }
  const bool carry = command.lift == 1;
  const int unit = carry || command.shelf_id != 0 ? findUnit(world, command.shelf_id)
                                                  : carriedUnit(world, robot);
  if (carry) checkCarry(world, robot, unit);
  const std::string& name = world.storage.units[unit].name;
  if (!carry && world.fleet.unit[robot] != unit) throw Refusal("it does not carry " + name);
  Route route(world, robot);
  route.lift(carry ? MotionSegment::Kind::kRaise : MotionSegment::Kind::kLower, unit);
  return {route.takeSegments(), (carry ? "carry " : "drop ") + name, name};
}

Plan plan(const WorldState& world, int robot, const Command& command) {
  switch (command.kind) {
    case Command::Kind::kMoveTo:
      return planMoveTo(world, robot, command);
    case Command::Kind::kMoveX:
      return planMoveAlong(world, robot, 0, command.x);
    case Command::Kind::kMoveY:
      return planMoveAlong(world, robot, 1, command.y);
    case Command::Kind::kRotate:
      return planRotate(world, robot, command.direction);
    case Command::Kind::kLift:
      return planLift(world, robot, command);
    default:
      break;
  }
  throw Refusal("unknown command");
}

const char* stateName(State state) {
  static const char* const names[] = {"IDLE",    "MOVING_X", "MOVING_Y", "ROTATING",
                                      "LIFTING", "BLOCKED",  "WAITING"};
  return names[static_cast<int>(state)];
}

void checkIdle(const WorldState& world, int robot) {
  if (world.fleet.status[robot] == Status::kIdle) return;
  throw Refusal(std::string("it is not idle but ") + stateName(world.fleet.state[robot]));
}

void start(WorldState& world, int robot, std::uint32_t number, Plan plan) {
  Task& task = world.fleet.tasks[robot];
  task.command = number;
  task.goal = plan.text;
  reportCommand(world, Event::Kind::kAccepted, robot, plan.other, plan.text);
  beginTask(world, robot, std::move(plan.segments));
}

using Order = void (*)(WorldState&, int robot);

/// Of the command kinds that are obeyed whatever a robot is at.
Order orderOf(Command::Kind kind) {
  switch (kind) {
    case Command::Kind::kCancel:
      return cancel;
    case Command::Kind::kStop:
      return stop;
    case Command::Kind::kGoOn:
      return goOn;
    default:
      return nullptr;
  }
}

bool hears(const WorldState& world, int robot) {
  return (world.fleet.failures[robot] & bitOf(Failure::kRadio)) == 0;
}

int findListening(const WorldState& world, int id) {
  const int robot = world.fleet.find(id);
  if (robot < 0) throw Refusal("there is no robot kiva" + std::to_string(id));
  if (!hears(world, robot)) throw Refusal("its radio is lost: it hears nothing");
  return robot;
}

void obeyAll(WorldState& world, Order order) {
  for (int robot = 0; robot < world.fleet.size(); ++robot) {
    if (hears(world, robot)) order(world, robot);
  }
}

/// Gives the command to its robot; `path` is what it stands for, if it is to follow one. Counts it,
/// unless it only changes what the robot is at. Throws Refusal.
void obey(WorldState& world, const Command& command, const FollowPath& path) {
  if (!path.fault.empty()) throw Refusal(path.fault);
  const bool is_stop = command.kind == Command::Kind::kStop || command.kind == Command::Kind::kGoOn;
  const Order order = orderOf(command.kind);
  if (is_stop && command.kiva_id == 0) return obeyAll(world, order);
  const int robot = findListening(world, command.kiva_id);
  if (order) return order(world, robot);
  const bool follows = command.kind == Command::Kind::kFollow;
  if (follows && changesPath(world, robot, path)) return changePath(world, robot, path);
  checkIdle(world, robot);
  const std::uint32_t number = world.inbox.last_number + 1;
  if (follows) {
    startPath(world, robot, number, path);
  } else {
    start(world, robot, number, plan(world, robot, command));
  }
  world.inbox.last_number = number;
}

/// A client may tell an idle robot something at each step; to find that there is no way back takes
/// longer than all else that a step does for it.
void restFromLooking(WorldState& world, int kiva_id) {
  double& until = world.fleet.wedged_until[world.fleet.find(kiva_id)];
  const auto now = static_cast<double>(world.clock.total_steps);
  if (until <= now) until = now + static_cast<double>(world.clock.stepsIn(kLookAgain));
}

void answer(WorldState& world, const Command& command, const FollowPath& path) {
  try {
    obey(world, command, path);
  } catch (const Refusal& refusal) {
    if (dynamic_cast<const Wedged*>(&refusal)) restFromLooking(world, command.kiva_id);
    const bool is_fleets = command.kiva_id == 0 && !path.fault.empty();
    world.log.events.push_back({world.clock.time(),
                                Event::Kind::kRefused,
                                is_fleets ? "" : "kiva" + std::to_string(command.kiva_id),
                                "",
                                refusal.what(),
                                ++world.inbox.last_number,
                                {}});
  }
}

/// The first of the queued paths, which the command stands for; empty if it stands for none.
FollowPath takePath(WorldState& world, const Command& command) {
  FollowPath path;
  if (command.kind != Command::Kind::kFollow) return path;
  path = std::move(world.inbox.paths.front());
  world.inbox.paths.pop_front();
  return path;
}

}  // namespace

void acceptCommands(WorldState& world) {
  receive(world);
  while (!world.inbox.commands.empty()) {
    const Command& command = world.inbox.commands.front();
    answer(world, command, takePath(world, command));
    world.inbox.commands.pop_front();
  }
}

void haltCrashed(WorldState& world) {
  for (const Crash& crash : world.contact_log.crashes) {
    const int robot = world.fleet.find(crash.kiva_id);
    if (robot >= 0) haltRobot(world, robot, crash.with, "collision with " + crash.with);
  }
  world.contact_log.crashes.clear();
}

}  // namespace kiva
