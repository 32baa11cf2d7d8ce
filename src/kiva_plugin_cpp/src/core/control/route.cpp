// SPDX-License-Identifier: Apache-2.0
#include "core/control/route.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/angle.h"
#include "core/sensing/look_ahead.h"

namespace kiva {
namespace {

constexpr double kHalfPi = M_PI / 2;
constexpr double kOnGrid = 0.001;              // [m]: a robot within stands on its grid point
constexpr double kSquare = 0.01 * M_PI / 180;  // [rad]: a heading within is along the grid
constexpr double kNearGrid = 0.02;             // [m], [rad]: of one that has to find out
constexpr int kRecoverCells = 2;               // around a robot that looks for a free grid point
constexpr double kRoomStep = 0.1;              // [m]: in which it looks for room to turn
constexpr double kRoomReach = 1.5;             // [m]

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

/// Whether a robot may be told to return there.
bool isNear(const WorldState& world, const Point& here, const Point& back) {
  const double far = std::max(std::abs(back.x - here.x), std::abs(back.y - here.y));
  return far < kRecoverCells * world.grid_spacing && isOnFloor(world, back);
}

/// The nearest place straight ahead or behind where the robot has room to turn; here, if it has
/// room here or nowhere.
Point roomToTurn(const WorldState& world, int robot) {
  const PlanarPose at = world.fleet.believed(robot);
  const Point here{at.x, at.y};
  const double c = std::cos(at.yaw), s = std::sin(at.yaw);
  for (int step = 0; step * kRoomStep <= kRoomReach; ++step) {
    for (double way : {step * kRoomStep, -step * kRoomStep}) {
      const Point p{here.x + c * way, here.y + s * way};
      if (isFree(world, robot, p.x, p.y)) return p;
    }
  }
  return here;
}

}  // namespace

double nearestGrid(const WorldState& world, double coordinate) {
  return std::round(coordinate / world.grid_spacing) * world.grid_spacing;
}

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

void checkMotion(const WorldState& world, int robot) {
  if (!world.fleet.robots[robot].has_motion) throw Refusal("it has no motion plugin");
}

bool isOnFloor(const WorldState& world, const Point& p) {
  const double half = world.grid_spacing / 2 - 1e-6;
  const Floor& floor = world.floor;
  return p.x - half >= floor.min_x && p.x + half <= floor.max_x && p.y - half >= floor.min_y &&
         p.y + half <= floor.max_y;
}

Route::Route(const WorldState& world, int robot, const Point* back)
    : world_(world),
      robot_(robot),
      here_(world.fleet.believed(robot)),
      at_{nearestGrid(world, here_.x), nearestGrid(world, here_.y)},
      yaw_(std::round(here_.yaw / kHalfPi) * kHalfPi) {
  const bool localises = world.fleet.localises;
  const double off = std::hypot(here_.x - at_.x, here_.y - at_.y);
  if (off > (localises ? kNearGrid : kOnGrid)) {
    recover(back);
  } else if (std::abs(here_.yaw - yaw_) > (localises ? kNearGrid : kSquare)) {
    turnTo(yaw_);
  }
}

void Route::rotate(int direction) { turnTo(yaw_ + direction * kHalfPi); }

void Route::driveTo(int axis, double coordinate) {
  const double way = coordinate - at_[axis];
  if (std::abs(way) < kGoalTolerance) return;
  const double angle = axis * kHalfPi + (way < 0 ? M_PI : 0);
  const double heading = headingNear(yaw_, angle);
  if (std::abs(heading - yaw_) > kSquare) turnTo(heading);
  at_[axis] = coordinate;
  MotionSegment segment = makeDrive(axis == 0 ? State::kMovingX : State::kMovingY);
  segments_.push_back(segment);
}

void Route::lift(MotionSegment::Kind kind, int unit) {
  MotionSegment segment;
  segment.kind = kind;
  segment.unit = unit;
  segment.state = State::kLifting;
  segments_.push_back(segment);
}

void Route::turnTo(double heading) {
  if (!world_.fleet.robots[robot_].has_rotation) throw Refusal("it has no rotation plugin");
  MotionSegment segment;
  segment.yaw = yaw_ = heading;
  segments_.push_back(segment);
}

MotionSegment Route::makeDrive(State state) const {
  MotionSegment segment;
  segment.kind = MotionSegment::Kind::kDrive;
  segment.x = at_.x;
  segment.y = at_.y;
  segment.yaw = yaw_;
  segment.state = state;
  return segment;
}

/// Back to the grid from wherever it was pushed: out to where there is room to turn, then straight
/// to a grid point, by the smaller turn, forwards or backwards.
void Route::recover(const Point* back) {
  const Point here{here_.x, here_.y}, room = roomToTurn(world_, robot_);
  const bool is_told =
      back != nullptr && isNear(world_, here, *back) && isFree(world_, robot_, back->x, back->y);
  const Point to = is_told ? *back : nearestFree(world_, robot_, room);
  yaw_ = here_.yaw;
  driveOff(here, room);
  driveOff(room, to);
  const double square = std::round(yaw_ / kHalfPi) * kHalfPi;
  if (std::abs(square - yaw_) > kSquare) turnTo(square);
  yaw_ = square;
}

/// Straight from one place to another, off the grid.
void Route::driveOff(const Point& from, const Point& to) {
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

}  // namespace kiva
