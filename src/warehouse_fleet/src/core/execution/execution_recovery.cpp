// SPDX-License-Identifier: Apache-2.0
//
// Brings robots that were pushed back to the grid, and keeps others clear of them.
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/execution/execution_limits.h"
#include "warehouse_fleet/execution.h"

namespace fleet {
namespace {

constexpr double kOnGrid = 0.001;  // tolerance within which a robot stands on a grid point [m]
constexpr int kRefuges = 1;        // distance in cells within which it may come back to the grid
constexpr double kFindsBack = 30;  // time within which it must come back [s]
constexpr double kAgain = 2;       // time between attempts that ended where they began [s]
constexpr double kReach = 0.43;    // half extent of a robot with its load along x and y [m]
constexpr double kInside = 0.37;   // half extent that never leaves released cells [m]
constexpr double kTurning = 0.05;  // distance from a cell's middle within which robots turn [m]
constexpr double kPassing = 0.07;  // reach into a cell that is safe while others pass [m]
constexpr double kHalf = 0.4;      // half length and half width of a load [m]
constexpr double kSweep = 0.58;    // radius that a turning load sweeps, with a margin [m]
constexpr double kRoom = 1.2;      // room of a robot that turns and drives back to the grid [m]

/// Returns evenly spaced positions from one end to the other, at most a cell apart.
std::vector<double> marks(double from, double to, double spacing) {
  const int gaps = static_cast<int>(std::ceil((to - from) / spacing));
  std::vector<double> marks;
  for (int i = 0; i <= gaps; ++i) marks.push_back(from + (to - from) * i / gaps);
  return marks;
}

}  // namespace

/// Makes an obstacle hold the cells that it stands on, and drives onto next.
void Execution::occupy(int robot) {
  courses_[robot].at = frame_.cellAt(reports_[robot].x, reports_[robot].y);
  cover(robot);
}

/// Makes a robot that was pushed off the middle of its cell, or off its path, hold all cells that
/// it stands on, until it is back.
void Execution::keepAround(int robot) {
  Course& course = courses_[robot];
  const bool rests = !course.isActive() && reports_[robot].status == RobotStatus::kIdle;
  if (isBack(robot)) {
    course.is_astray = false;
    course.recovery = {};
  } else if (rests) {
    course.is_astray = true;
  }
  vacate(robot);
  if (course.is_astray || isOffItsPath(robot)) cover(robot);
}

/// Returns whether a robot reaches into a cell that it does not hold. For a robot that turns in the
/// middle of its cell, mayTurn() keeps others clear.
bool Execution::isOffItsPath(int robot) const {
  if (!isSquare(robot) && !isCentred(robot, kTurning)) return true;
  const double reach = kInside * motion_.spacing;
  for (const double x : {-reach, reach}) {
    for (const double y : {-reach, reach}) {
      const Cell cell = frame_.cellAt(reports_[robot].x + x, reports_[robot].y + y);
      if (cell != kNowhere && holders_.holder(cell) != robot) return true;
    }
  }
  return false;
}

/// Returns the half extent of a robot along x and y with its load, which may stand askew [m].
double Execution::reachOf(int robot) const {
  const double yaw = reports_[robot].yaw;
  const double corner = kHalf * (std::abs(std::cos(yaw)) + std::abs(std::sin(yaw)));
  return std::max(kReach, corner - kPassing);
}

void Execution::cover(int robot) {
  Course& course = courses_[robot];
  const Report& report = reports_[robot];
  const bool is_trying = course.recovery.since >= 0 && !isLost(robot);  // between attempts, too
  const bool is_coming_back = course.is_astray && (course.isActive() || is_trying);
  const double reach = (is_coming_back ? kRoom : reachOf(robot)) * motion_.spacing;
  const double ahead = 0.7 * motion_.spacing;
  const double speed = std::hypot(report.vx, report.vy);
  const double dx = speed > kStandstill ? ahead * report.vx / speed : 0;
  const double dy = speed > kStandstill ? ahead * report.vy / speed : 0;
  for (const double x :
       marks(std::min(0.0, dx) - reach, std::max(0.0, dx) + reach, motion_.spacing)) {
    for (const double y :
         marks(std::min(0.0, dy) - reach, std::max(0.0, dy) + reach, motion_.spacing)) {
      const Cell cell = frame_.cellAt(report.x + x, report.y + y);
      if (cell == kNowhere || holders_.holder(cell) != kNobody) continue;
      holders_.hold(cell, robot);
      course.occupied.push_back(cell);
    }
  }
}

void Execution::vacate(int robot) {
  for (const Cell cell : courses_[robot].occupied) holders_.free(cell, robot);
  courses_[robot].occupied.clear();
}

/// Sends an astray robot to the middle of a cell, where its next path can begin, by a path of that
/// one cell. The robot refuses a cell in which it has no room to turn.
void Execution::recentre(int robot) {
  Course& course = courses_[robot];
  if (course.isAccepted() || course.isRefused() || isLost(robot)) return;
  if (course.isActive() && now_ - course.sent <= kUnanswered) return;
  if (!course.isActive() && now_ - course.recovery.ended <= kAgain) return;
  if (course.recovery.since < 0) course.recovery.since = now_;
  if (!course.isActive()) {
    const Cell back = refuge(robot);
    if (back == kNowhere) {
      course.recovery.refused.clear();  // there may be room by now
      return;
    }
    vacate(robot);
    holders_.free(course.at, robot);
    holders_.hold(back, robot);
    course.at = back;
    course.cells = {back};
    cover(robot);
    ++course.id;
  }
  course.plan.clear();
  course.plan_is_stale = true;
  send(robot, 0);
}

/// Returns the nearest cell in which a path can begin and that the robot has not refused, or
/// kNowhere.
Cell Execution::refuge(int robot) const {
  const Report& report = reports_[robot];
  Cell nearest = kNowhere;
  double least = 0;
  for (int row = -kRefuges; row <= kRefuges; ++row) {
    for (int column = -kRefuges; column <= kRefuges; ++column) {
      const Cell cell =
          frame_.cellAt(report.x + column * motion_.spacing, report.y + row * motion_.spacing);
      if (cell == kNowhere || !mayRest(robot, cell)) continue;
      const double far = std::hypot(frame_.xOf(cell) - report.x, frame_.yOf(cell) - report.y);
      if (nearest != kNowhere && far >= least) continue;
      nearest = cell;
      least = far;
    }
  }
  return nearest;
}

bool Execution::mayRest(int robot, Cell cell) const {
  const Course& course = courses_[robot];
  if (!floor_.isPassable(cell) || holders_.isClosed(cell, now_)) return false;
  if (!holders_.isFreeFor(cell, robot)) return false;
  const std::vector<Cell>& refused = course.recovery.refused;
  if (std::find(refused.begin(), refused.end(), cell) != refused.end()) return false;
  if (!reports_[robot].is_loaded || cell == course.at) return true;
  const std::vector<Cell>& units = holders_.units();
  return !floor_.isStorage(cell) && std::find(units.begin(), units.end(), cell) == units.end();
}

/// Returns whether a path can begin where a robot stands. The limit is narrower if the robot has
/// refused a path there.
bool Execution::isBack(int robot) const {
  const bool has_refused = !courses_[robot].recovery.refused.empty();
  return isCentred(robot, has_refused ? kOnGrid : kCentred) && isSquare(robot);
}

bool Execution::isLost(int robot) const {
  const double since = courses_.at(robot).recovery.since;
  return since >= 0 && now_ - since > kFindsBack;
}

/// Collects the cells in which a turning load would touch a robot that stands askew. Robots that
/// drive straight on pass it with room to spare.
void Execution::findTight() {
  tight_.clear();
  for (int robot = 0; robot < robots(); ++robot) {
    if (!isAskew(robot)) continue;
    const Cell at = frame_.cellAt(reports_[robot].x, reports_[robot].y);
    if (at == kNowhere) continue;
    for (int heading = 0; heading < kHeadings; ++heading) {
      const Cell beside = floor_.beside(at, heading);
      if (beside == kNowhere) continue;
      for (const Cell cell : {beside, floor_.beside(beside, heading + 1)}) {
        if (cell == kNowhere || holders_.holder(cell) == robot) continue;  // closed anyway
        if (isInReach(robot, cell)) tight_.push_back(cell);
      }
    }
  }
  std::sort(tight_.begin(), tight_.end());
  tight_.erase(std::unique(tight_.begin(), tight_.end()), tight_.end());
}

bool Execution::isAskew(int robot) const {
  const Course& course = courses_[robot];
  if (course.isMember() && !course.is_astray) return false;
  return !isCentred(robot, kCentred) || !isSquare(robot);
}

/// Returns whether a load that turns in a cell would touch the robot's load.
bool Execution::isInReach(int robot, Cell cell) const {
  const Report& report = reports_[robot];
  const double c = std::cos(report.yaw), s = std::sin(report.yaw);
  const double dx = frame_.xOf(cell) - report.x, dy = frame_.yOf(cell) - report.y;
  const double along = std::max(0.0, std::abs(c * dx + s * dy) - kHalf);
  const double across = std::max(0.0, std::abs(c * dy - s * dx) - kHalf);
  return std::hypot(along, across) < kSweep;
}

}  // namespace fleet
