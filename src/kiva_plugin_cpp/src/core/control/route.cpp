// SPDX-License-Identifier: Apache-2.0
#include "core/control/route.h"

#include <algorithm>
#include <cmath>

#include "core/control/recovery.h"
#include "core/geometry/angle.h"

namespace kiva {
namespace {

constexpr double kOnGrid = 0.001;              // [m] within which a robot is on its grid point
constexpr double kSquare = 0.01 * M_PI / 180;  // [rad] within which a heading is along the grid
constexpr double kNearGrid =
    0.02;  // [m], [rad]: both tolerances of a robot that estimates its pose
constexpr double kAside =
    0.05;  // [m] off its line up to which a robot without a way back may go on

}  // namespace

void checkGoal(const Scene& world, const Point& goal) {
  if (isOnFloor(world, goal)) return;
  const FloorExtent& f = world.floor.extent;
  if (f.max_x <= f.min_x) throw Refusal("there is no floor to drive on");
  throw Refusal(format("goal (%g, %g) is outside the floor, which spans x %g…%g m, y %g…%g m",
                       goal.x, goal.y, f.min_x, f.max_x, f.min_y, f.max_y));
}

double checkedGoal(const WorldSettings& settings, double coordinate, char axis) {
  if (!std::isfinite(coordinate)) {
    throw Refusal(format("%c = %g: a finite number of metres was expected", axis, coordinate));
  }
  const double grid = nearestGrid(settings, coordinate);
  if (std::abs(grid - coordinate) <= kGoalTolerance) return grid;
  throw Refusal(
      format("%c = %g m is off the grid of %g m", axis, coordinate, settings.grid_spacing));
}

void checkMotion(const FleetState& fleet, int robot) {
  if (!fleet.robots[robot].has_motion) throw Refusal("it has no motion plugin");
}

Route::Route(const Scene& world, int robot, const Point* back)
    : world_(world),
      robot_(robot),
      here_(world.fleet.believed(robot)),
      at_{nearestGrid(world.settings, here_.x), nearestGrid(world.settings, here_.y)},
      yaw_(squareTo(here_.yaw)) {
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

/// Plans the way back to the grid. Without a way, a robot that stands a little off its line goes
/// on: the next drive leads it back to the line.
void Route::recover(const Point* back) {
  Point from{here_.x, here_.y};
  const bool is_wedged =
      world_.fleet.wedged_until[robot_] > static_cast<double>(world_.clock.total_steps);
  if (is_wedged) throw Wedged();
  const std::vector<Point> way = findWayBack(world_, robot_, back);
  if (way.empty() && std::hypot(from.x - at_.x, from.y - at_.y) > kAside) throw Wedged();
  yaw_ = here_.yaw;
  for (const Point& to : way) {
    driveOff(from, to);
    from = to;
  }
  const double square = squareTo(yaw_);
  if (std::abs(square - yaw_) > kSquare) turnTo(square);
  yaw_ = square;
}

/// Drives straight from one place to another, off the grid.
void Route::driveOff(const Point& from, const Point& to) {
  const StraightWay way = straightWay({from.x, from.y, yaw_}, to);
  if (std::abs(way.length) < kOnGrid) return;
  if (std::abs(way.heading - yaw_) > kSquare) turnTo(way.heading);
  yaw_ = way.heading;
  at_ = to;
  MotionSegment segment = makeDrive(
      std::abs(to.x - from.x) > std::abs(to.y - from.y) ? State::kMovingX : State::kMovingY);
  segment.reverse = way.length < 0;
  segment.on_grid = false;
  segments_.push_back(segment);
}

}  // namespace kiva
