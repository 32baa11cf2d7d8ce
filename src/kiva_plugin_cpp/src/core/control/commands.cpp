// SPDX-License-Identifier: Apache-2.0
#include "core/control/commands.h"

#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "core/models/load.h"
#include "core/motion/cruise.h"
#include "core/sensing/sensing.h"

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
  std::deque<MotionSegment> segments;
  std::string text;
  std::string other;
};

template <typename... Args>
std::string format(const char* pattern, Args... args) {
  char text[256];
  std::snprintf(text, sizeof text, pattern, args...);
  return text;
}

double nearestGrid(const WorldState& world, double coordinate) {
  return std::round(coordinate / world.grid_spacing) * world.grid_spacing;
}

/// The heading nearest to `near` that points along `angle`; of two opposite ones the left turn.
double headingNear(double near, double angle) {
  const double turn = wrapAngle(angle - near);
  return near + (turn < -M_PI + 1e-6 ? turn + 2 * M_PI : turn);
}

bool isOnFloor(const WorldState& world, const Point& p) {
  const double half = world.grid_spacing / 2 - 1e-6;
  const Floor& floor = world.floor;
  return p.x - half >= floor.min_x && p.x + half <= floor.max_x && p.y - half >= floor.min_y &&
         p.y + half <= floor.max_y;
}

/// The free grid point nearest to a place. Throws Refusal if there is none near.
Point nearestFree(const WorldState& world, int robot, const Point& from) {
  Point best;
  double least = 1e9;
  for (int i = -kRecoverCells; i <= kRecoverCells; ++i) {
    for (int j = -kRecoverCells; j <= kRecoverCells; ++j) {
      const Point p{nearestGrid(world, from.x) + i * world.grid_spacing,
                    nearestGrid(world, from.y) + j * world.grid_spacing};
      const double distance = std::hypot(p.x - from.x, p.y - from.y);
      if (distance >= least || !isOnFloor(world, p) || !isFree(world, robot, p.x, p.y)) continue;
      least = distance;
      best = p;
    }
  }
  if (least > 1e8) throw Refusal("it is off the grid and no free grid point is near");
  return best;
}

/// The nearest place straight ahead or behind where the robot has room to turn; here, if it has
/// room here or nowhere.
Point roomToTurn(const WorldState& world, int robot) {
  const Fleet& f = world.fleet;
  const Point here{f.x[robot], f.y[robot]};
  const double c = std::cos(f.yaw[robot]), s = std::sin(f.yaw[robot]);
  for (int step = 0; step * kRoomStep <= kRoomReach; ++step) {
    for (double way : {step * kRoomStep, -step * kRoomStep}) {
      const Point p{here.x + c * way, here.y + s * way};
      if (isFree(world, robot, p.x, p.y)) return p;
    }
  }
  return here;
}

/// Plans the way of one robot, segment by segment; knows where each segment will leave it.
class Planner {
 public:
  Planner(const WorldState& world, int robot)
      : state_(world),
        robot_(robot),
        at_{nearestGrid(world, world.fleet.x[robot]), nearestGrid(world, world.fleet.y[robot])},
        yaw_(std::round(world.fleet.yaw[robot] / kHalfPi) * kHalfPi) {
    const Fleet& f = world.fleet;
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
    MotionSegment segment = makeDrive(axis == 0 ? State::kMovingX : State::kMovingY);
    segments_.push_back(segment);
  }

  void lift(MotionSegment::Kind kind, int unit) {
    MotionSegment segment;
    segment.kind = kind;
    segment.unit = unit;
    segment.state = State::kLifting;
    segments_.push_back(segment);
  }

  std::deque<MotionSegment> takeSegments() { return std::move(segments_); }

 private:
  void turnTo(double heading) {
    if (!state_.fleet.robots[robot_].has_rotation) throw Refusal("it has no rotation plugin");
    MotionSegment segment;
    segment.yaw = yaw_ = heading;
    segments_.push_back(segment);
  }

  MotionSegment makeDrive(State state) const {
    MotionSegment segment;
    segment.kind = MotionSegment::Kind::kDrive;
    segment.x = at_.x;
    segment.y = at_.y;
    segment.yaw = yaw_;
    segment.state = state;
    return segment;
  }

  /// Back to the grid from wherever it was pushed: out to where there is room to turn, then
  /// straight to a grid point, by the smaller turn, forwards or backwards.
  void recover() {
    const Fleet& f = state_.fleet;
    const Point here{f.x[robot_], f.y[robot_]}, room = roomToTurn(state_, robot_);
    const Point to = nearestFree(state_, robot_, room);
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
    MotionSegment segment =
        makeDrive(std::abs(dx) > std::abs(dy) ? State::kMovingX : State::kMovingY);
    segment.reverse = reverse;
    segment.on_grid = false;
    segments_.push_back(segment);
  }

  const WorldState& state_;
  int robot_;
  Point at_;
  double yaw_;
  std::deque<MotionSegment> segments_;
};

void checkGoal(const WorldState& world, const Point& goal) {
  if (isOnFloor(world, goal)) return;
  const Floor& f = world.floor;
  if (f.max_x <= f.min_x) throw Refusal("there is no floor to drive on");
  throw Refusal(format("goal (%g, %g) is outside the floor, which spans x %g…%g m, y %g…%g m",
                       goal.x, goal.y, f.min_x, f.max_x, f.min_y, f.max_y));
}

double checkedGoal(const WorldState& world, double coordinate, char axis) {
  if (!std::isfinite(coordinate)) {
    throw Refusal(format("%c = %g: a finite number of metres was expected", axis, coordinate));
  }
  const double grid = nearestGrid(world, coordinate);
  if (std::abs(grid - coordinate) <= kGoalTolerance) return grid;
  throw Refusal(format("%c = %g m is off the grid of %g m", axis, coordinate, world.grid_spacing));
}

double checkedDistance(const WorldState& world, double distance) {
  if (!std::isfinite(distance)) {
    throw Refusal(format("distance %g: a finite number of metres was expected", distance));
  }
  const double whole = nearestGrid(world, distance);
  if (std::abs(whole - distance) <= kGoalTolerance) return whole;
  throw Refusal(
      format("distance %g m is no whole number of %g m cells", distance, world.grid_spacing));
}

void checkMotion(const WorldState& world, int robot) {
  if (!world.fleet.robots[robot].has_motion) throw Refusal("it has no motion plugin");
}

Plan planMoveTo(const WorldState& world, int robot, const Command& command) {
  checkMotion(world, robot);
  const Point goal{checkedGoal(world, command.x, 'x'), checkedGoal(world, command.y, 'y')};
  checkGoal(world, goal);
  Planner planner(world, robot);
  planner.driveTo(0, goal.x);
  planner.driveTo(1, goal.y);
  return {planner.takeSegments(), format("go to (%g, %g)", goal.x, goal.y), ""};
}

Plan planMoveAlong(const WorldState& world, int robot, int axis, double asked) {
  checkMotion(world, robot);
  const double distance = checkedDistance(world, asked);
  Planner planner(world, robot);
  Point goal = planner.at();
  goal[axis] += distance;
  checkGoal(world, goal);
  planner.driveTo(axis, goal[axis]);
  return {planner.takeSegments(), format("go %g m along %c", distance, axis == 0 ? 'x' : 'y'), ""};
}

Plan planRotate(const WorldState& world, int robot, int direction) {
  if (direction != 1 && direction != -1) {
    throw Refusal(
        format("direction %d: 1 (counterclockwise) or -1 (clockwise) was expected", direction));
  }
  Planner planner(world, robot);
  planner.rotate(direction);
  return {planner.takeSegments(), direction > 0 ? "turn counterclockwise" : "turn clockwise", ""};
}

int findUnit(const WorldState& world, int id) {
  const auto at = world.unit_of_id.find(id);
  if (at == world.unit_of_id.end()) throw Refusal(format("there is no storage_unit%d", id));
  return at->second;
}

void checkCarry(const WorldState& world, int robot, int unit) {
  const Fleet& f = world.fleet;
  const StorageUnit& u = world.units[unit];
  const LiftParameters& lift = f.robots[robot].lift;
  if (f.unit[robot] >= 0) throw Refusal("it carries " + world.units[f.unit[robot]].name);
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

Plan planLift(const WorldState& world, int robot, const Command& command) {
  if (!world.fleet.robots[robot].lift.fitted) throw Refusal("it has no lift plugin");
  if (command.lift != 0 && command.lift != 1) {
    throw Refusal(format("status %d: 1 (carry) or 0 (drop) was expected", command.lift));
  }
  const int unit = findUnit(world, command.shelf_id);
  const bool carry = command.lift == 1;
  if (carry) checkCarry(world, robot, unit);
  const std::string& name = world.units[unit].name;
  if (!carry && world.fleet.unit[robot] != unit) throw Refusal("it does not carry " + name);
  Planner planner(world, robot);
  planner.lift(carry ? MotionSegment::Kind::kRaise : MotionSegment::Kind::kLower, unit);
  return {planner.takeSegments(), (carry ? "carry " : "drop ") + name, name};
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
  }
  throw Refusal("unknown command");
}

const char* stateName(State state) {
  static const char* const names[] = {"IDLE",     "MOVING_X", "MOVING_Y",
                                      "ROTATING", "LIFTING",  "BLOCKED"};
  return names[static_cast<int>(state)];
}

void become(WorldState& world, int robot, Status status, State state) {
  world.fleet.robots[robot].segment_started = false;
  world.fleet.look_again[robot] = 0;  // it moves otherwise from now on
  world.setStatus(robot, status, state);
}

void start(WorldState& world, int robot, Plan plan) {
  Robot& r = world.fleet.robots[robot];
  world.report(Event::Kind::kAccepted, r.name, plan.other, plan.text);
  r.segments = std::move(plan.segments);
  r.stopping = r.halting = false;
  if (r.segments.empty()) {
    world.report(Event::Kind::kDone, r.name, "", "is there already");
    return;
  }
  for (const MotionSegment& segment : r.segments) {
    if (segment.kind == MotionSegment::Kind::kRaise) world.units[segment.unit].claimed_by = robot;
  }
  world.fleet.awake[robot] = 1;
  become(world, robot, Status::kBusy, r.segments.front().state);
}

void answer(WorldState& world, const Command& command) {
  const int robot = world.fleet.find(command.kiva_id);
  const std::string name = "kiva" + std::to_string(command.kiva_id);
  try {
    if (robot < 0) throw Refusal("there is no robot " + name);
    if (world.fleet.status[robot] != Status::kIdle) {
      throw Refusal(std::string("it is not idle but ") + stateName(world.fleet.state[robot]));
    }
    start(world, robot, plan(world, robot, command));
  } catch (const Refusal& refusal) {
    world.report(Event::Kind::kRefused, name, "", refusal.what());
  }
}

void becomeIdle(WorldState& world, int robot) {
  Fleet& f = world.fleet;
  clearCommand(world, robot);
  f.wheel_target[0][robot] = f.wheel_target[1][robot] = 0;
  become(world, robot, Status::kIdle, State::kIdle);
}

}  // namespace

double wrapAngle(double angle) { return std::remainder(angle, 2 * M_PI); }

void acceptCommands(WorldState& world) {
  while (!world.commands.empty()) {
    answer(world, world.commands.front());
    world.commands.pop_front();
  }
}

void finishSegment(WorldState& world, int robot) {
  Robot& r = world.fleet.robots[robot];
  if (r.stopping) return endBlocked(world, robot);
  r.segments.pop_front();
  if (!r.segments.empty()) return become(world, robot, Status::kBusy, r.segments.front().state);
  becomeIdle(world, robot);
  world.report(Event::Kind::kDone, r.name, "", "");
}

void markBlocked(WorldState& world, int robot, const std::string& by, const std::string& reason) {
  Robot& r = world.fleet.robots[robot];
  if (r.segments.empty()) return;
  if (!r.stopping) {
    r.blocked_by = by;
    r.blocked_reason = reason;
  }
  r.stopping = true;
  world.setStatus(robot, Status::kBlocked, State::kBlocked);
}

void endBlocked(WorldState& world, int robot) {
  const Robot& r = world.fleet.robots[robot];
  const std::string by = r.blocked_by, reason = r.blocked_reason;
  becomeIdle(world, robot);
  world.report(Event::Kind::kBlocked, r.name, by, reason);
}

void haltRobot(WorldState& world, int robot, const std::string& by, const std::string& reason) {
  Robot& r = world.fleet.robots[robot];
  if (r.segments.empty()) return;
  const MotionSegment::Kind kind = r.segments.front().kind;
  if (kind != MotionSegment::Kind::kTurn && kind != MotionSegment::Kind::kDrive)
    return;  // it stands, and goes on
  markBlocked(world, robot, by, reason);
  stopCruise(world.fleet, robot);
  r.halting = true;
}

void clearCommand(WorldState& world, int robot) {
  Robot& r = world.fleet.robots[robot];
  for (const MotionSegment& segment : r.segments) {
    if (segment.unit >= 0 && world.units[segment.unit].claimed_by == robot) {
      world.units[segment.unit].claimed_by = -1;
    }
  }
  stopCruise(world.fleet, robot);
  r.segments.clear();
  r.segment_started = r.stopping = r.halting = false;
}

}  // namespace kiva
