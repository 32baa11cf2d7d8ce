// SPDX-License-Identifier: Apache-2.0
#include "core/control/commands.h"

#include <cmath>
#include <cstdio>

#include "core/control/interruptions.h"
#include "core/control/paths.h"
#include "core/control/route.h"
#include "core/models/load.h"
#include "core/state/places/unit_geometry.h"
#include "core/state/progress/tasks.h"

namespace kiva {
namespace {

constexpr double kLookAgain = 0.5;  // [s] between two searches for a way back

struct CommandPlan {
  std::deque<MotionSegment> segments;
  std::string text;
  std::string other;
};

double checkedDistance(const WorldSettings& settings, double distance) {
  if (!std::isfinite(distance)) {
    throw Refusal(format("distance %g: a finite number of metres was expected", distance));
  }
  const double whole = nearestGrid(settings, distance);
  if (std::abs(whole - distance) <= kGoalTolerance) return whole;
  throw Refusal(
      format("distance %g m is not a whole number of %g m cells", distance, settings.grid_spacing));
}

CommandPlan planMoveTo(const Scene& world, int robot, const Command& command) {
  checkMotion(world.fleet, robot);
  const Point goal{checkedGoal(world.settings, command.x, 'x'),
                   checkedGoal(world.settings, command.y, 'y')};
  checkGoal(world, goal);
  Route route(world, robot);
  route.driveTo(0, goal.x);
  route.driveTo(1, goal.y);
  return {route.takeSegments(), format("go to (%g, %g)", goal.x, goal.y), ""};
}

CommandPlan planMoveAlong(const Scene& world, int robot, int axis, double asked) {
  checkMotion(world.fleet, robot);
  const double distance = checkedDistance(world.settings, asked);
  Route route(world, robot);
  Point goal = route.at();
  goal[axis] += distance;
  checkGoal(world, goal);
  route.driveTo(axis, goal[axis]);
  return {route.takeSegments(), format("go %g m along %c", distance, axis == 0 ? 'x' : 'y'), ""};
}

CommandPlan planRotate(const Scene& world, int robot, int direction) {
  if (direction != 1 && direction != -1) {
    throw Refusal(
        format("direction %d: 1 (counterclockwise) or -1 (clockwise) was expected", direction));
  }
  Route route(world, robot);
  route.rotate(direction);
  return {route.takeSegments(), direction > 0 ? "turn counterclockwise" : "turn clockwise", ""};
}

int findUnit(const Storage& storage, int id) {
  const auto at = storage.unit_of_id.find(id);
  if (at == storage.unit_of_id.end()) throw Refusal(format("there is no storage_unit%d", id));
  return at->second;
}

void checkCarry(const Scene& world, int robot, int unit) {
  const Fleet& f = world.fleet;
  const StorageUnit& u = world.storage.units[unit];
  const LiftParameters& lift = f.robots[robot].lift;
  if (f.unit[robot] >= 0) throw Refusal("it carries " + world.storage.units[f.unit[robot]].name);
  const int holder = u.carrier >= 0 ? u.carrier : u.claimed_by;
  if (holder >= 0) throw Refusal(u.name + " is carried by " + f.robots[holder].name);
  const double distance = unitDistance(world, robot, unit);
  if (!(distance <= lift.proximity)) {
    throw Refusal(format("%s is %.3f m away; at most %g m is close enough", u.name.c_str(),
                         distance, lift.proximity));
  }
  if (!standsUpright(world, unit)) throw Refusal(u.name + " does not stand upright on the floor");
  if (u.mass > lift.max_load) {
    throw Refusal(format("%s weighs %g kg, more than the %g kg it can carry", u.name.c_str(),
                         u.mass, lift.max_load));
  }
  const double beyond = overhang(world, robot, unit);
  if (beyond >= 0) {
    throw Refusal(format("%s would tip off: its centre of mass lies %.3f m beyond the plate",
                         u.name.c_str(), beyond));
  }
  if (towerGap(world, robot, unit) >= lift.height) {
    throw Refusal(
        format("its tower rises %g m, which does not reach %s", lift.height, u.name.c_str()));
  }
}

/// Returns the unit for a drop without a number. Throws Refusal.
int carriedUnit(const FleetState& fleet, int robot) {
  const int unit = fleet.unit[robot];
  if (unit < 0) throw Refusal("it carries nothing");
  return unit;
}

CommandPlan planLift(const Scene& world, int robot, const Command& command) {
  if (!world.fleet.robots[robot].lift.fitted) throw Refusal("it has no lift plugin");
  if (command.lift != 0 && command.lift != 1) {
    throw Refusal(format("status %d: 1 (carry) or 0 (drop) was expected", command.lift));
  }
  const bool carry = command.lift == 1;
  const int unit = carry || command.shelf_id != 0 ? findUnit(world.storage, command.shelf_id)
                                                  : carriedUnit(world.fleet, robot);
  if (carry) checkCarry(world, robot, unit);
  const std::string& name = world.storage.units[unit].name;
  if (!carry && world.fleet.unit[robot] != unit) throw Refusal("it does not carry " + name);
  Route route(world, robot);
  route.lift(carry ? MotionSegment::Kind::kRaise : MotionSegment::Kind::kLower, unit);
  return {route.takeSegments(), (carry ? "carry " : "drop ") + name, name};
}

CommandPlan plan(const Scene& world, int robot, const Command& command) {
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
                                      "LIFTING", "BLOCKED",  "WAITING",  "STEERED"};
  return names[static_cast<int>(state)];
}

void checkIdle(const FleetState& fleet, int robot) {
  if (fleet.status[robot] == Status::kIdle) return;
  if (fleet.tasks[robot].isSteered()) throw Steered(fleet.robots[robot].name);
  throw Refusal(std::string("it is not idle but ") + stateName(fleet.state[robot]));
}

void start(TaskView& world, int robot, std::uint32_t number, CommandPlan plan) {
  Task& task = world.fleet.tasks[robot];
  task.command = number;
  task.request = plan.text;
  reportCommand(world, world.log, Event::Kind::kAccepted, robot, plan.other, plan.text);
  beginTask(world, robot, std::move(plan.segments));
}

using Order = void (*)(RobotView&, int robot);

/// Returns the order of a command to one robot or to all; null for other kinds.
Order orderOf(Command::Kind kind) {
  switch (kind) {
    case Command::Kind::kStop:
      return stop;
    case Command::Kind::kGoOn:
      return goOn;
    default:
      return nullptr;
  }
}

bool hears(const FleetState& fleet, int robot) {
  return (fleet.failures[robot] & bitOf(Failure::kRadio)) == 0;
}

int findListening(const FleetState& fleet, int id) {
  const int robot = fleet.find(id);
  if (robot < 0) throw Refusal("there is no robot kiva" + std::to_string(id));
  if (!hears(fleet, robot)) throw Refusal("its radio is lost: it hears nothing");
  return robot;
}

void commandAll(RobotView& world, Order order) {
  for (int robot = 0; robot < world.fleet.size(); ++robot) {
    if (hears(world.fleet, robot)) order(world, robot);
  }
}

/// Gives the command to its robot. `path` is the path of a kFollow. Numbers the command, unless it
/// only changes the present one. Throws Refusal.
void obey(TaskView& world, Obstacles& obstacles, Inbox& inbox, const Command& command,
          const FollowPath& path) {
  if (!path.fault.empty()) throw Refusal(path.fault);
  const Order order = orderOf(command.kind);
  if (order && command.kiva_id == 0) return commandAll(world, order);
  const int robot = findListening(world.fleet, command.kiva_id);
  if (order) return order(world, robot);
  if (command.kind == Command::Kind::kCancel) return cancel(world, obstacles, robot);
  const bool follows = command.kind == Command::Kind::kFollow;
  if (follows && changesPath(world.fleet, robot, path))
    return changePath(world, obstacles, robot, path);
  checkIdle(world.fleet, robot);
  const std::uint32_t number = inbox.last_command + 1;
  if (follows) {
    startPath(world, robot, number, path);
  } else {
    start(world, robot, number, plan(world, robot, command));
  }
  inbox.last_command = number;
}

/// Postpones the next search for a way back. A client may command an idle robot at each step, and a
/// search that fails takes longer than the rest of the robot's step.
void backOff(RobotView& world, int kiva_id) {
  double& until = world.fleet.wedged_until[world.fleet.find(kiva_id)];
  const auto now = static_cast<double>(world.clock.total_steps);
  if (until <= now) until = now + static_cast<double>(world.clock.stepsIn(kLookAgain));
}

void answer(TaskView& world, Obstacles& obstacles, Inbox& inbox, const Command& command,
            const FollowPath& path) {
  try {
    obey(world, obstacles, inbox, command, path);
  } catch (const Refusal& refusal) {
    if (dynamic_cast<const Wedged*>(&refusal)) backOff(world, command.kiva_id);
    const bool is_fleets = command.kiva_id == 0 && !path.fault.empty();
    world.log.events.push_back({world.clock.time(),
                                Event::Kind::kRefused,
                                is_fleets ? "" : "kiva" + std::to_string(command.kiva_id),
                                "",
                                refusal.what(),
                                ++inbox.last_command,
                                {}});
  }
}

}  // namespace

void acceptCommands(TaskView& world, Obstacles& obstacles, Inbox& inbox, const Shadows& shadows) {
  while (!inbox.pending.empty()) {
    const PendingCommand& next = inbox.pending.front();
    if (!shadows.has(next.command.kiva_id))
      answer(world, obstacles, inbox, next.command, next.path);
    inbox.pending.pop_front();
  }
}

void haltCollidedRobots(TaskView& world, ContactLog& contacts) {
  for (const Crash& crash : contacts.crashes) {
    const int robot = world.fleet.find(crash.kiva_id);
    if (robot >= 0) haltRobot(world, robot, crash.with, "collision with " + crash.with);
  }
  contacts.crashes.clear();
}

}  // namespace kiva
