// SPDX-License-Identifier: Apache-2.0
//
// Releases cells to robots, as soon as they are free and it is the robot's turn.
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/execution/execution_limits.h"
#include "warehouse_fleet/execution.h"

namespace fleet {
namespace {

constexpr double kTurnsSoon =
    0.35;  // distance from a corner at which cells beyond it are released [m]
constexpr double kClosedFor = 3;  // time for which an obstacle is assumed to stay [s]
constexpr std::size_t kForesight =
    8;  // planned cells that a robot is sent beyond its released ones

}  // namespace

Releases Execution::release() {
  for (int robot = 0; robot < robots(); ++robot) {
    if (courses_[robot].isMember()) extend(robot);
  }
  return std::exchange(releases_, {});
}

void Execution::extend(int robot) {
  Course& course = courses_[robot];
  course.waits_for = kNobody;
  course.hindrance = Hindrance::kNone;
  const bool is_busy = reports_[robot].is_busy;
  if (!reports_[robot].is_controlled || course.isWithdrawn() || isBroken(robot)) return;
  if (course.is_astray) {
    if (!is_busy) recentre(robot);
    return;
  }
  const int before = course.points();
  if (!is_busy) grant(robot);
  const bool is_new = course.points() > before;
  if (is_new && !course.isActive()) {
    ++course.id;
    send(robot, 0);
  } else if (is_new) {
    send(robot, course.isAccepted() ? before : 0);
  } else {
    sendAgain(robot);
  }
}

/// Has a robot hold the next cells of its plan that it needs and may have.
void Execution::grant(int robot) {
  Course& course = courses_[robot];
  while (!course.plan.empty() && needs(robot)) {
    const Cell cell = course.plan.front().cell;
    const Cell tip = course.cells.back();
    const int arrival = course.cells.size() > 1 && course.reached < course.points()
                            ? frame_.headingTo(course.cells[course.cells.size() - 2], tip)
                            : headingOf(robot);
    const bool turns = frame_.headingTo(tip, cell) != arrival;
    if (turns && !mayTurn(robot)) {
      course.hindrance = Hindrance::kTurn;
      break;
    }
    if (!mayHave(robot, cell)) break;
    if (turns) course.turning = tip;
    holders_.hold(cell, robot);
    course.cells.push_back(cell);
    course.granted.push_back(cell);
    course.plan.pop_front();
  }
}

/// Repeats a release that a robot does not act upon, even to one that is busy: its path ends where
/// it is to stay, as in an elevator.
void Execution::sendAgain(int robot) {
  const Course& course = courses_[robot];
  if (!course.isActive() || now_ - course.sent <= kUnanswered) return;
  const bool is_waiting = course.isAccepted() && reports_[robot].state == RobotState::kWaiting &&
                          course.reached < course.points();
  if (is_waiting) send(robot, course.reached);
  if (isAtEnd(robot)) releaseUpTo(robot, course.points());
  if (course.phase() == CoursePhase::kSent) send(robot, 0);
}

/// Returns whether a robot waits for a path although it has no goal elsewhere.
bool Execution::isAtEnd(int robot) const {
  const Course& course = courses_[robot];
  return course.isAccepted() && !course.travels && course.plan.empty() &&
         reports_[robot].state == RobotState::kWaiting && course.reached == course.points();
}

bool Execution::mayHave(int robot, Cell cell) {
  if (holders_.isFenced(courses_[robot].cells.back(), cell)) return false;
  const int holder = holders_.holder(cell);
  const bool is_held = holder != kNobody && holder != robot;
  const int next = is_held ? holder : order_.first(cell, courses_);
  if (next == robot) return true;
  courses_[robot].waits_for = next;
  courses_[robot].hindrance = is_held ? Hindrance::kHolder : Hindrance::kOrder;
  return false;
}

/// Returns whether a robot would have to brake before the next release.
bool Execution::needs(int robot) const {
  const double latency = motion_.latency + courses_[robot].pose_gap;
  const double soon = std::min(motion_.speed, speedOf(robot) + motion_.acceleration * latency);
  const double way = soon * latency + soon * soon / (2 * motion_.acceleration);
  return toGo(robot) < way;
}

/// Returns whether a robot may be released around a corner. Two robots side by side, one of them
/// loaded, must not turn at the same time; nor must a loaded robot beside one that stands askew. A
/// robot is released around a corner only after it comes to it.
bool Execution::mayTurn(int robot) const {
  const Cell tip = courses_[robot].cells.back();
  if (toGo(robot) > kTurnsSoon) return false;
  const bool is_tight = std::binary_search(tight_.begin(), tight_.end(), tip);
  if (is_tight && reports_[robot].is_loaded) return false;
  for (int heading = 0; heading < kHeadings; ++heading) {
    const Cell beside = floor_.beside(tip, heading);
    const int other = beside == kNowhere ? kNobody : holders_.holder(beside);
    if (other == kNobody || other == robot || !keepsFromTurning(other, beside, tip)) continue;
    if (reports_[robot].is_loaded || reports_[other].is_loaded) return false;
  }
  return true;
}

/// Returns whether a robot turns in the cell `in`, or still enters it from the cell `from`. A load
/// that turns in `from` would touch it before it reaches the middle.
bool Execution::keepsFromTurning(int robot, Cell in, Cell from) const {
  const Course& course = courses_[robot];
  if (course.turning == in) return true;
  return course.is_short && course.at == in && course.cells[course.reached - 2] == from;
}

/// Returns whether a robot has passed the corner that it was released around.
bool Execution::hasTurned(int robot) const {
  const Course& course = courses_[robot];
  const auto corner = std::find(course.cells.rbegin(), course.cells.rend(), course.turning);
  const auto point = course.cells.rend() - corner - 1;
  if (point + 1 >= course.points()) return true;
  if (course.reached < point + 1) return false;
  const double yaw = kQuarter * frame_.headingTo(course.turning, course.cells[point + 1]);
  return std::abs(std::remainder(reports_[robot].yaw - yaw, 4 * kQuarter)) < kAligned;
}

/// Sends the points of a path from `first` on, and the next planned ones.
void Execution::send(int robot, int first) {
  Course& course = courses_[robot];
  const int released = course.points();
  releases_.robot.push_back(robot);
  releases_.path_id.push_back(course.id);
  releases_.first.push_back(first);
  releases_.released.push_back(released);
  releases_.cells.insert(releases_.cells.end(), course.cells.begin() + first, course.cells.end());
  const std::size_t foreseen = std::min(course.plan.size(), kForesight);
  for (std::size_t i = 0; i < foreseen; ++i) releases_.cells.push_back(course.plan[i].cell);
  releases_.points.push_back(static_cast<std::uint32_t>(released - first + foreseen));
  course.sent = now_;
  course.send();
}

/// Releases `points` points of a path. The last point is sent again, which cuts off the points
/// planned beyond.
void Execution::releaseUpTo(int robot, int points) {
  Course& course = courses_[robot];
  course.sent = now_;
  releases_.robot.push_back(robot);
  releases_.path_id.push_back(course.id);
  releases_.first.push_back(points - 1);
  releases_.points.push_back(1);
  releases_.cells.push_back(course.cells[points - 1]);
  releases_.released.push_back(points);
}

void Execution::refused(int robot) {
  if (robot < 0 || robot >= static_cast<int>(courses_.size())) return;
  Course& course = courses_[robot];
  course.refuse();
}

/// Ends a path where the robot can still stop, before an obstacle. The robot keeps its cells until
/// it reports that it has stopped. The message is repeated until then: a robot that drives on
/// refuses it.
void Execution::withdraw(int robot) {
  Course& course = courses_[robot];
  const int keep =
      std::min<int>(course.cells.size(), course.reached + (isCentred(robot, kCentred) ? 0 : 1));
  const bool is_blocked = reports_[robot].state == RobotState::kBlocked;
  if (is_blocked && keep < course.points()) {
    holders_.close(course.cells[keep], now_ + kClosedFor);
  }
  if (course.isWithdrawn() && now_ - course.sent < kUnanswered) return;
  course.withdraw();
  releaseUpTo(robot, keep);
}

void Execution::setClosedZone(std::vector<Cell> cells) {
  holders_.setClosedZone(std::move(cells));
  for (const Cell cell : holders_.closedZone()) {
    const int robot = holders_.holder(cell);
    if (robot == kNobody) continue;
    const Cell at = courses_[robot].at;
    if (at != kNowhere && !holders_.isInClosedZone(at)) recall(cell);
  }
}

void Execution::recall(Cell cell) {
  const int robot = floor_.has(cell) ? holders_.holder(cell) : kNobody;
  if (robot == kNobody) return;
  const Course& course = courses_[robot];
  const auto ahead = course.cells.begin() + course.reached;
  const bool is_ahead = std::find(ahead, course.cells.end(), cell) != course.cells.end();
  if (is_ahead && course.isAccepted() && !course.isWithdrawn()) withdraw(robot);
}

/// Returns the distance to the last released cell [m].
double Execution::toGo(int robot) const {
  const Course& course = courses_[robot];
  const int points = course.points();
  if (course.reached >= points) return 0;
  const Cell next = course.cells[course.reached];
  const Report& report = reports_[robot];
  return std::abs(frame_.xOf(next) - report.x) + std::abs(frame_.yOf(next) - report.y) +
         (points - course.reached - 1) * motion_.spacing;
}

}  // namespace fleet
