// SPDX-License-Identifier: Apache-2.0
#include "commands.h"

#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "cruise.h"
#include "load.h"
#include "sensing.h"

namespace kiva {
namespace {

constexpr double kHalfPi = M_PI / 2;
constexpr double kOnGrid = 0.001;              // [m]: a robot within stands on its grid point
constexpr double kSquare = 0.01 * M_PI / 180;  // [rad]: a heading within is along the grid
constexpr double kGoalTolerance = 0.001;       // [m]: for numbers that clients computed
constexpr int kRecoverCells = 2;               // around a robot that looks for a free grid point
constexpr double kRoomStep = 0.1;              // [m]: in which it looks for room to turn
constexpr double kRoomReach = 1.5;             // [m]

struct Refusal : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct Point {
  double x = 0, y = 0;
  double& operator[](int axis) { return axis == 0 ? x : y; }
};

struct Plan {
  std::deque<Leg> legs;
  std::string text;
  std::string other;
};

template <typename... Args>
std::string format(const char* pattern, Args... args) {
  char text[256];
  std::snprintf(text, sizeof text, pattern, args...);
  return text;
}

double nearestGrid(const Parts& parts, double coordinate) {
  return std::round(coordinate / parts.grid_spacing) * parts.grid_spacing;
}

/// The heading nearest to `near` that points along `angle`; of two opposite ones the left turn.
double headingNear(double near, double angle) {
  const double turn = wrapAngle(angle - near);
  return near + (turn < -M_PI + 1e-6 ? turn + 2 * M_PI : turn);
}

bool isOnFloor(const Parts& parts, const Point& p) {
  const double half = parts.grid_spacing / 2 - 1e-6;
  const Floor& floor = parts.floor;
  return p.x - half >= floor.min_x && p.x + half <= floor.max_x && p.y - half >= floor.min_y &&
         p.y + half <= floor.max_y;
}

/// The free grid point nearest to a place. Throws Refusal if there is none near.
Point nearestFree(const Parts& parts, int robot, const Point& from) {
  Point best;
  double least = 1e9;
  for (int i = -kRecoverCells; i <= kRecoverCells; ++i) {
    for (int j = -kRecoverCells; j <= kRecoverCells; ++j) {
      const Point p{nearestGrid(parts, from.x) + i * parts.grid_spacing,
                    nearestGrid(parts, from.y) + j * parts.grid_spacing};
      const double distance = std::hypot(p.x - from.x, p.y - from.y);
      if (distance >= least || !isOnFloor(parts, p) || !isFree(parts, robot, p.x, p.y)) continue;
      least = distance;
      best = p;
    }
  }
  if (least > 1e8) throw Refusal("it is off the grid and no free grid point is near");
  return best;
}

/// The nearest place straight ahead or behind where the robot has room to turn; here, if it has
/// room here or nowhere.
Point roomToTurn(const Parts& parts, int robot) {
  const Fleet& f = parts.fleet;
  const Point here{f.x[robot], f.y[robot]};
  const double c = std::cos(f.yaw[robot]), s = std::sin(f.yaw[robot]);
  for (int step = 0; step * kRoomStep <= kRoomReach; ++step) {
    for (double way : {step * kRoomStep, -step * kRoomStep}) {
      const Point p{here.x + c * way, here.y + s * way};
      if (isFree(parts, robot, p.x, p.y)) return p;
    }
  }
  return here;
}

/// Plans the way of one robot, leg by leg; knows where each leg will leave it.
class Planner {
 public:
  Planner(const Parts& parts, int robot)
      : parts_(parts),
        robot_(robot),
        at_{nearestGrid(parts, parts.fleet.x[robot]), nearestGrid(parts, parts.fleet.y[robot])},
        yaw_(std::round(parts.fleet.yaw[robot] / kHalfPi) * kHalfPi) {
    const Fleet& f = parts.fleet;
    const double off = std::hypot(f.x[robot] - at_.x, f.y[robot] - at_.y);
    if (off > kOnGrid) {
      recover();
    } else if (std::abs(f.yaw[robot] - yaw_) > kSquare) {
      turnTo(yaw_);
    }
  }

  Point at() const { return at_; }

  void rotate(int direction) { turnTo(yaw_ + direction * kHalfPi); }

  /// Drives along one axis to that coordinate, facing it.
  void driveTo(int axis, double coordinate) {
    const double way = coordinate - at_[axis];
    if (std::abs(way) < kGoalTolerance) return;
    const double angle = axis * kHalfPi + (way < 0 ? M_PI : 0);
    const double heading = headingNear(yaw_, angle);
    if (std::abs(heading - yaw_) > kSquare) turnTo(heading);
    at_[axis] = coordinate;
    Leg leg = makeDrive(axis == 0 ? State::kMovingX : State::kMovingY);
    legs_.push_back(leg);
  }

  void lift(Leg::Kind kind, int unit) {
    Leg leg;
    leg.kind = kind;
    leg.unit = unit;
    leg.state = State::kLifting;
    legs_.push_back(leg);
  }

  std::deque<Leg> takeLegs() { return std::move(legs_); }

 private:
  void turnTo(double heading) {
    if (!parts_.fleet.robots[robot_].has_rotation) throw Refusal("it has no rotation plugin");
    Leg leg;
    leg.yaw = yaw_ = heading;
    legs_.push_back(leg);
  }

  Leg makeDrive(State state) const {
    Leg leg;
    leg.kind = Leg::Kind::kDrive;
    leg.x = at_.x;
    leg.y = at_.y;
    leg.yaw = yaw_;
    leg.state = state;
    return leg;
  }

  /// Back to the grid from wherever it was pushed: out to where there is room to turn, then
  /// straight to a grid point, by the smaller turn, forwards or backwards.
  void recover() {
    const Fleet& f = parts_.fleet;
    const Point here{f.x[robot_], f.y[robot_]}, room = roomToTurn(parts_, robot_);
    const Point to = nearestFree(parts_, robot_, room);
    yaw_ = f.yaw[robot_];
    driveOff(here, room);
    driveOff(room, to);
    const double square = std::round(yaw_ / kHalfPi) * kHalfPi;
    if (std::abs(square - yaw_) > kSquare) turnTo(square);
    yaw_ = square;
  }

  /// Straight from one place to another, off the grid.
  void driveOff(const Point& from, const Point& to) {
    const double dx = to.x - from.x, dy = to.y - from.y;
    if (std::hypot(dx, dy) < kOnGrid) return;
    const double ahead = headingNear(yaw_, std::atan2(dy, dx));
    const double back = headingNear(yaw_, std::atan2(-dy, -dx));
    const bool reverse = std::abs(back - yaw_) < std::abs(ahead - yaw_);
    const double heading = reverse ? back : ahead;
    if (std::abs(heading - yaw_) > kSquare) turnTo(heading);
    yaw_ = heading;
    at_ = to;
    Leg leg = makeDrive(std::abs(dx) > std::abs(dy) ? State::kMovingX : State::kMovingY);
    leg.reverse = reverse;
    leg.on_grid = false;
    legs_.push_back(leg);
  }

  const Parts& parts_;
  int robot_;
  Point at_;
  double yaw_;
  std::deque<Leg> legs_;
};

void checkGoal(const Parts& parts, const Point& goal) {
  if (isOnFloor(parts, goal)) return;
  const Floor& f = parts.floor;
  if (f.max_x <= f.min_x) throw Refusal("there is no floor to drive on");
  throw Refusal(format("goal (%g, %g) is outside the floor, which spans x %g…%g m, y %g…%g m",
                       goal.x, goal.y, f.min_x, f.max_x, f.min_y, f.max_y));
}

double checkedGoal(const Parts& parts, double coordinate, char axis) {
  if (!std::isfinite(coordinate)) {
    throw Refusal(format("%c = %g: a finite number of metres was expected", axis, coordinate));
  }
  const double grid = nearestGrid(parts, coordinate);
  if (std::abs(grid - coordinate) <= kGoalTolerance) return grid;
  throw Refusal(format("%c = %g m is off the grid of %g m", axis, coordinate, parts.grid_spacing));
}

double checkedDistance(const Parts& parts, double distance) {
  if (!std::isfinite(distance)) {
    throw Refusal(format("distance %g: a finite number of metres was expected", distance));
  }
  const double whole = nearestGrid(parts, distance);
  if (std::abs(whole - distance) <= kGoalTolerance) return whole;
  throw Refusal(
      format("distance %g m is no whole number of %g m cells", distance, parts.grid_spacing));
}

void checkMotion(const Parts& parts, int robot) {
  if (!parts.fleet.robots[robot].has_motion) throw Refusal("it has no motion plugin");
}

Plan planMoveTo(const Parts& parts, int robot, const Command& command) {
  checkMotion(parts, robot);
  const Point goal{checkedGoal(parts, command.x, 'x'), checkedGoal(parts, command.y, 'y')};
  checkGoal(parts, goal);
  Planner planner(parts, robot);
  planner.driveTo(0, goal.x);
  planner.driveTo(1, goal.y);
  return {planner.takeLegs(), format("go to (%g, %g)", goal.x, goal.y), ""};
}

Plan planMoveAlong(const Parts& parts, int robot, int axis, double asked) {
  checkMotion(parts, robot);
  const double distance = checkedDistance(parts, asked);
  Planner planner(parts, robot);
  Point goal = planner.at();
  goal[axis] += distance;
  checkGoal(parts, goal);
  planner.driveTo(axis, goal[axis]);
  return {planner.takeLegs(), format("go %g m along %c", distance, axis == 0 ? 'x' : 'y'), ""};
}

Plan planRotate(const Parts& parts, int robot, int direction) {
  if (direction != 1 && direction != -1) {
    throw Refusal(
        format("direction %d: 1 (counterclockwise) or -1 (clockwise) was expected", direction));
  }
  Planner planner(parts, robot);
  planner.rotate(direction);
  return {planner.takeLegs(), direction > 0 ? "turn counterclockwise" : "turn clockwise", ""};
}

int findUnit(const Parts& parts, int id) {
  const auto at = parts.unit_of_id.find(id);
  if (at == parts.unit_of_id.end()) throw Refusal(format("there is no storage_unit%d", id));
  return at->second;
}

void checkCarry(const Parts& parts, int robot, int unit) {
  const Fleet& f = parts.fleet;
  const StorageUnit& u = parts.units[unit];
  const LiftParameters& lift = f.robots[robot].lift;
  if (f.unit[robot] >= 0) throw Refusal("it carries " + parts.units[f.unit[robot]].name);
  const int holder = u.carrier >= 0 ? u.carrier : u.claimed_by;
  if (holder >= 0) throw Refusal(u.name + " is carried by " + f.robots[holder].name);
  const double distance = unitDistance(parts, robot, unit);
  if (!(distance <= lift.proximity)) {
    throw Refusal(format("%s is %.3f m away; %g m at the most is close enough", u.name.c_str(),
                         distance, lift.proximity));
  }
  if (!standsUpright(parts, unit)) throw Refusal(u.name + " does not stand upright on the floor");
  if (u.mass > lift.max_load) {
    throw Refusal(format("%s weighs %g kg, more than the %g kg it can carry", u.name.c_str(),
                         u.mass, lift.max_load));
  }
  if (towerGap(parts, robot, unit) >= lift.height) {
    throw Refusal(
        format("its tower rises %g m, which does not reach %s", lift.height, u.name.c_str()));
  }
}

Plan planLift(const Parts& parts, int robot, const Command& command) {
  if (!parts.fleet.robots[robot].lift.fitted) throw Refusal("it has no lift plugin");
  if (command.lift != 0 && command.lift != 1) {
    throw Refusal(format("status %d: 1 (carry) or 0 (drop) was expected", command.lift));
  }
  const int unit = findUnit(parts, command.shelf_id);
  const bool carry = command.lift == 1;
  if (carry) checkCarry(parts, robot, unit);
  const std::string& name = parts.units[unit].name;
  if (!carry && parts.fleet.unit[robot] != unit) throw Refusal("it does not carry " + name);
  Planner planner(parts, robot);
  planner.lift(carry ? Leg::Kind::kRaise : Leg::Kind::kLower, unit);
  return {planner.takeLegs(), (carry ? "carry " : "drop ") + name, name};
}

Plan plan(const Parts& parts, int robot, const Command& command) {
  switch (command.kind) {
    case Command::Kind::kMoveTo:
      return planMoveTo(parts, robot, command);
    case Command::Kind::kMoveX:
      return planMoveAlong(parts, robot, 0, command.x);
    case Command::Kind::kMoveY:
      return planMoveAlong(parts, robot, 1, command.y);
    case Command::Kind::kRotate:
      return planRotate(parts, robot, command.direction);
    case Command::Kind::kLift:
      return planLift(parts, robot, command);
  }
  throw Refusal("unknown command");
}

const char* stateName(State state) {
  static const char* const names[] = {"IDLE",     "MOVING_X", "MOVING_Y",
                                      "ROTATING", "LIFTING",  "BLOCKED"};
  return names[static_cast<int>(state)];
}

void become(Parts& parts, int robot, Status status, State state) {
  parts.fleet.robots[robot].leg_started = false;
  parts.fleet.look_again[robot] = 0;  // it moves otherwise from now on
  parts.setStatus(robot, status, state);
}

void start(Parts& parts, int robot, Plan plan) {
  Robot& r = parts.fleet.robots[robot];
  parts.report(Event::Kind::kAccepted, r.name, plan.other, plan.text);
  r.legs = std::move(plan.legs);
  r.stopping = r.halting = false;
  if (r.legs.empty()) {
    parts.report(Event::Kind::kDone, r.name, "", "is there already");
    return;
  }
  for (const Leg& leg : r.legs) {
    if (leg.kind == Leg::Kind::kRaise) parts.units[leg.unit].claimed_by = robot;
  }
  parts.fleet.awake[robot] = 1;
  become(parts, robot, Status::kBusy, r.legs.front().state);
}

void answer(Parts& parts, const Command& command) {
  const int robot = parts.fleet.find(command.kiva_id);
  const std::string name = "kiva" + std::to_string(command.kiva_id);
  try {
    if (robot < 0) throw Refusal("there is no robot " + name);
    if (parts.fleet.status[robot] != Status::kIdle) {
      throw Refusal(std::string("it is not idle but ") + stateName(parts.fleet.state[robot]));
    }
    start(parts, robot, plan(parts, robot, command));
  } catch (const Refusal& refusal) {
    parts.report(Event::Kind::kRefused, name, "", refusal.what());
  }
}

void becomeIdle(Parts& parts, int robot) {
  Fleet& f = parts.fleet;
  clearCommand(parts, robot);
  f.wheel_target[0][robot] = f.wheel_target[1][robot] = 0;
  become(parts, robot, Status::kIdle, State::kIdle);
}

}  // namespace

double wrapAngle(double angle) { return std::remainder(angle, 2 * M_PI); }

void acceptCommands(Parts& parts) {
  while (!parts.commands.empty()) {
    answer(parts, parts.commands.front());
    parts.commands.pop_front();
  }
}

void finishLeg(Parts& parts, int robot) {
  Robot& r = parts.fleet.robots[robot];
  if (r.stopping) return endBlocked(parts, robot);
  r.legs.pop_front();
  if (!r.legs.empty()) return become(parts, robot, Status::kBusy, r.legs.front().state);
  becomeIdle(parts, robot);
  parts.report(Event::Kind::kDone, r.name, "", "");
}

void markBlocked(Parts& parts, int robot, const std::string& by, const std::string& reason) {
  Robot& r = parts.fleet.robots[robot];
  if (r.legs.empty()) return;
  if (!r.stopping) {
    r.blocked_by = by;
    r.blocked_reason = reason;
  }
  r.stopping = true;
  parts.setStatus(robot, Status::kBlocked, State::kBlocked);
}

void endBlocked(Parts& parts, int robot) {
  const Robot& r = parts.fleet.robots[robot];
  const std::string by = r.blocked_by, reason = r.blocked_reason;
  becomeIdle(parts, robot);
  parts.report(Event::Kind::kBlocked, r.name, by, reason);
}

void haltRobot(Parts& parts, int robot, const std::string& by, const std::string& reason) {
  Robot& r = parts.fleet.robots[robot];
  if (r.legs.empty()) return;
  const Leg::Kind kind = r.legs.front().kind;
  if (kind != Leg::Kind::kTurn && kind != Leg::Kind::kDrive) return;  // it stands, and goes on
  markBlocked(parts, robot, by, reason);
  stopCruise(parts.fleet, robot);
  r.halting = true;
}

void clearCommand(Parts& parts, int robot) {
  Robot& r = parts.fleet.robots[robot];
  for (const Leg& leg : r.legs) {
    if (leg.unit >= 0 && parts.units[leg.unit].claimed_by == robot) {
      parts.units[leg.unit].claimed_by = -1;
    }
  }
  stopCruise(parts.fleet, robot);
  r.legs.clear();
  r.leg_started = r.stopping = r.halting = false;
}

}  // namespace kiva
