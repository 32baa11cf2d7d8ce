// SPDX-License-Identifier: Apache-2.0
//
// Takes the reports of robots, and admits robots to the fleet.
#include "warehouse_fleet/execution.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "core/execution/execution_limits.h"

namespace fleet {
namespace {

constexpr int kInsists = 3;        // refusals after which a path must begin elsewhere
constexpr double kSettled = 1;     // time after which no message is on its way any more [s]
constexpr double kBlockedFor = 1;  // time after which a robot is sent another way [s]
constexpr double kNoWay = 0.001;   // distance between two reports up to which a robot stands [m]
constexpr double kStalledFor = 5;  // time after which a robot counts as broken [s]
constexpr double kLongestGap = 2;  // largest time between two poses that is reckoned with [s]
constexpr double kGapKept = 0.9;   // share of an earlier gap that a shorter one leaves

}  // namespace

Execution::Execution(const Floor& floor, const Motion& motion)
    : floor_(floor),
      motion_(motion),
      frame_(floor, motion),
      holders_(floor),
      order_(floor.size()) {}

void Execution::update(double time, std::vector<Report> reports) {
  const double elapsed = std::max(0.0, time - now_);
  now_ = time;
  const int robots = static_cast<int>(reports.size());
  if (reports.size() != courses_.size()) {
    holders_.clear();
    courses_.assign(reports.size(), {});
    order_.clear();
    members_.clear();
    reports_.resize(reports.size());
  }
  const std::vector<Report> before = std::exchange(reports_, std::move(reports));
  std::vector<int> outsiders;
  // Members of the fleet come first: obstacles get only the cells that members do not hold.
  for (int robot = 0; robot < robots; ++robot) {
    updateMember(robot, elapsed, before[robot]);
    if (!courses_[robot].isMember()) outsiders.push_back(robot);
  }
  for (const int robot : outsiders) updateOutsider(robot);
  findTight();
}

void Execution::updateMember(int robot, double elapsed, const Report& before) {
  Course& course = courses_[robot];
  if (rests(robot, before)) {
    course.still_since = course.moved = now_;
    return;
  }
  if (course.isMember() && !reports_[robot].is_controlled) {
    course.recovery = {};  // as a member it begins afresh, even if this path is not over
    if (isOver(robot)) dismiss(robot);
  }
  if (!course.isMember()) return;
  follow(robot);
  if (course.isMember()) keepAround(robot);
  measure(robot, elapsed, before);
  measureGap(robot, before);
}

/// Admits a robot that is no member if it can, or has it hold the cells that it stands on.
void Execution::updateOutsider(int robot) {
  Course& course = courses_[robot];
  course.still_since = now_;
  vacate(robot);
  if (reports_[robot].is_controlled) {
    admit(robot);
  } else {
    course.recovery = {};
  }
  course.isMember() ? keepAround(robot) : occupy(robot);
}

/// Returns whether nothing but time changed for a robot of the fleet: it stands, with nothing
/// ahead.
bool Execution::rests(int robot, const Report& before) const {
  const Course& course = courses_[robot];
  const Report& now = reports_[robot];
  const bool waits = course.isMember() && !course.isActive() && !course.travels &&
                     !course.is_astray && course.turning == kNowhere && course.occupied.empty();
  return waits && now.is_controlled && now.status == RobotStatus::kIdle &&
         before.status == RobotStatus::kIdle && now.x == before.x && now.y == before.y &&
         now.yaw == before.yaw && speedOf(robot) < kStandstill;
}

void Execution::setWork(const std::vector<std::uint8_t>& busy,
                        const std::vector<std::uint8_t>& loaded) {
  for (int robot = 0; robot < robots(); ++robot) {
    reports_[robot].is_busy = busy.at(robot);
    reports_[robot].is_loaded = loaded.at(robot);
  }
}

/// Makes a robot a member of the fleet, if it stands in a cell that no other robot holds.
void Execution::admit(int robot) {
  Course& course = courses_[robot];
  const Report& report = reports_[robot];
  if (report.status != RobotStatus::kIdle) return;
  Cell at = frame_.cellAt(report.x, report.y);
  if (at == kNowhere || !floor_.isPassable(at)) {
    if (course.recovery.since < 0) course.recovery.since = now_;
    at = refuge(robot);
  }
  if (at == kNowhere) return;
  if (holders_.holder(at) != kNobody && at != course.kept) return;
  vacate(robot);
  renew(robot);
  if (report.path_id > course.id) course.id = course.oldest = report.path_id;
  course.admit(at, now_, headingOf(robot));
  holders_.hold(at, robot);
  if (at == course.kept) course.kept = kNowhere;
}

/// Returns whether the robot has driven, or dropped, all of its released path.
bool Execution::isOver(int robot) const {
  const Course& course = courses_[robot];
  const Report& report = reports_[robot];
  if (!course.isActive()) return true;
  if (report.status != RobotStatus::kIdle && report.path_id == course.id) return false;
  return course.isAccepted() || now_ - course.sent > kSettled;
}

void Execution::dismiss(int robot) {
  Course& course = courses_[robot];
  vacate(robot);
  for (const Cell cell : course.cells) holders_.free(cell, robot);
  renew(robot);
}

/// Resets a course, except its ids and, while the robot is controlled, its recovery.
void Execution::renew(int robot) {
  Course next;
  next.id = courses_[robot].id;
  next.oldest = courses_[robot].oldest;
  next.kept = courses_[robot].kept;
  if (next.kept != kNowhere) {
    endRun(courses_[robot]);
    next.journey = courses_[robot].journey;
  }
  if (reports_[robot].is_controlled) next.recovery = std::move(courses_[robot].recovery);
  courses_[robot] = std::move(next);
}

bool Execution::keep(int robot, Cell cell) {
  Course& course = courses_.at(robot);
  if (cell == course.kept) return true;
  if (!floor_.has(cell) || holders_.holder(cell) != kNobody) return false;
  giveUp(robot);
  holders_.hold(cell, robot);
  course.kept = cell;
  return true;
}

void Execution::giveUp(int robot) {
  Course& course = courses_.at(robot);
  if (course.kept != kNowhere) holders_.free(course.kept, robot);
  course.kept = kNowhere;
}

/// Updates the progress of a member on its path.
void Execution::follow(int robot) {
  Course& course = courses_[robot];
  const Report& report = reports_[robot];
  if (course.turning != kNowhere && hasTurned(robot)) course.turning = kNowhere;
  if (!course.isActive()) {
    // The robot was moved by others.
    const Cell at = frame_.cellAt(report.x, report.y);
    if (at != course.at && !course.is_astray) {
      dismiss(robot);
      admit(robot);
    }
    return;
  }
  const bool is_reported = report.path_id == course.id;
  if (report.status == RobotStatus::kIdle) {
    // A refused release may have been sent twice; the duplicate can still be accepted. A robot
    // whose reports are lost may have accepted it already.
    const bool is_settled = now_ - course.sent > kSettled && !isBroken(robot);
    const bool is_dead = course.isRefused() && is_settled;
    if (course.isAccepted() || is_reported || is_dead) finish(robot);
    return;
  }
  if (!is_reported) return;
  course.accept();
  pass(robot, static_cast<int>(report.reached), static_cast<int>(report.left));
  if (report.state == RobotState::kBlocked) {
    if (course.blocked_since < 0) {
      course.blocked_since = now_;
      ++blocked_;
    }
    if (now_ - course.blocked_since >= kBlockedFor) withdraw(robot);
  } else {
    course.blocked_since = -1;
    if (course.isWithdrawn()) withdraw(robot);
  }
}

void Execution::pass(int robot, int reached, int left) {
  Course& course = courses_[robot];
  const int points = course.points();
  // A robot that has left a cell completely is in the next one, even before it reaches the middle.
  course.is_short = left >= reached;
  reached = std::clamp(std::max(reached, left + 1), course.reached, points);
  for (int point = course.reached; point < reached; ++point) {
    const int heading = frame_.headingTo(course.cells[point - 1], course.cells[point]);
    if (heading != course.run_heading) {
      const int quarters = (heading - course.run_heading) & 3;
      endRun(course);
      course.journey.alone += motion_.quarter * (quarters == 3 ? 1 : quarters);
      course.run_heading = heading;
    }
    ++course.run;
    ++course.journey.cells;
  }
  course.reached = reached;
  course.at = course.cells[reached - 1];
  left = std::clamp(left, course.left, reached - 1);
  for (int point = course.left; point < left; ++point) {
    const auto rest = course.cells.begin() + left;
    if (std::find(rest, course.cells.end(), course.cells[point]) == course.cells.end()) {
      holders_.free(course.cells[point], robot);
    }
  }
  course.left = left;
}

/// Ends a path, wherever the robot stands: it holds only that cell.
void Execution::finish(int robot) {
  Course& course = courses_[robot];
  const Report& report = reports_[robot];
  const Cell at = frame_.cellAt(report.x, report.y);
  if (course.isRefused() && (course.is_astray || ++course.refusals >= kInsists)) {
    course.recovery.refused.push_back(course.cells.front());
  } else if (course.isAccepted()) {
    course.recovery.refused.clear();
  }
  if (course.is_astray && !course.isRefused()) course.recovery.ended = now_;
  if (at == course.cells.back()) pass(robot, course.points(), 0);
  const bool was_withdrawn = course.isWithdrawn();
  vacate(robot);
  for (const Cell cell : course.cells) holders_.free(cell, robot);
  if (at == kNowhere || !holders_.isFreeFor(at, robot) || !floor_.isPassable(at)) {
    return dismiss(robot);
  }
  if (at != course.cells.back() || was_withdrawn) {
    course.plan_is_stale = true;
    course.plan.clear();
  }
  holders_.hold(at, robot);
  course.finish(at);
}

void Execution::measure(int robot, double elapsed, const Report& before) {
  Course& course = courses_[robot];
  if (!course.isMember()) return;
  const bool is_still =
      speedOf(robot) < kStandstill && reports_[robot].state != RobotState::kRotating;
  if (!course.travels || !is_still) course.still_since = now_;
  // A robot that is elsewhere may report no speed: positions must do.
  const double way = std::hypot(reports_[robot].x - before.x, reports_[robot].y - before.y);
  if (!is_still || way > kNoWay || course.reached == course.points()) course.moved = now_;
  if (!course.travels) return;
  course.journey.driven += elapsed;
  if (!is_still || toGo(robot) > kCentred || !waitsAsPlanned(robot)) return;
  course.journey.planned += elapsed;
  endRun(course);
}

void Execution::measureGap(int robot, const Report& before) {
  Course& course = courses_[robot];
  const Report& now = reports_[robot];
  const bool is_same = now.x == before.x && now.y == before.y && now.yaw == before.yaw;
  if (is_same && speedOf(robot) >= kStandstill) {
    course.pose_gap = std::clamp(now_ - course.posed, course.pose_gap, kLongestGap);
    return;
  }
  course.posed = now_;
  if (!is_same) course.pose_gap *= kGapKept;
}

/// Returns whether a robot stands because the plan makes it wait, or behind a robot that stands.
bool Execution::waitsAsPlanned(int robot) const {
  const Course& course = courses_[robot];
  if (course.waits_by_plan || course.waits_for == kNobody) return course.waits_by_plan;
  return speedOf(course.waits_for) < kStandstill;
}

/// Adds the time of a straight run to the journey.
void Execution::endRun(Course& course) const {
  if (course.run > 0) course.journey.alone += runTime(course.run * motion_.spacing, motion_);
  course.run = 0;
}

Journey Execution::takeJourney(int robot) {
  Course& course = courses_.at(robot);
  endRun(course);
  course.run_heading = headingOf(robot);
  Journey journey = course.journey;
  journey.planned += journey.alone;
  course.journey = {};
  return journey;
}

bool Execution::isDriving(int robot) const {
  const Report& report = reports_.at(robot);
  if (report.status == RobotStatus::kIdle) return false;
  // A robot that lifts or is served does not drive.
  return !report.is_busy || report.state == RobotState::kMovingX ||
         report.state == RobotState::kMovingY;
}

bool Execution::isForeign(int robot) const {
  const Course& course = courses_.at(robot);
  if (!isDriving(robot) || course.isOwn(reports_[robot].path_id)) return false;
  return !course.isActive() || course.isAccepted() || course.isRefused();
}

bool Execution::isOnDroppedPath(int robot) const {
  const Course& course = courses_.at(robot);
  const std::uint32_t path = reports_[robot].path_id;
  if (!isDriving(robot) || !course.isOwn(path)) return false;
  return !course.isActive() || path != course.id;
}

bool Execution::isStalled(int robot) const {
  const Course& course = courses_.at(robot);
  return isBroken(robot) || (course.isActive() && now_ - course.moved > kStalledFor);
}

bool Execution::stands(int robot) const {
  const Course& course = courses_.at(robot);
  return course.isMember() && !course.isActive() && !course.is_astray;
}

Heading Execution::headingOf(int robot) const {
  return turned(static_cast<int>(std::lround(reports_[robot].yaw / kQuarter)), 0);
}

double Execution::speedOf(int robot) const {
  return std::hypot(reports_[robot].vx, reports_[robot].vy);
}

bool Execution::isCentred(int robot, double within) const {
  const Report& report = reports_[robot];
  const Cell at = courses_[robot].at;
  return std::hypot(frame_.xOf(at) - report.x, frame_.yOf(at) - report.y) < within;
}

bool Execution::isSquare(int robot) const {
  return std::abs(std::remainder(reports_[robot].yaw, kQuarter)) < kAligned;
}

}  // namespace fleet
