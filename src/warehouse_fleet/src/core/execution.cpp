// SPDX-License-Identifier: Apache-2.0
#include "warehouse_fleet/execution.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace fleet {
namespace {

// KivaStatus.
constexpr std::uint8_t kStatusIdle = 0;
constexpr std::uint8_t kStateMovingX = 1, kStateMovingY = 2;
constexpr std::uint8_t kStateRotating = 3, kStateBlocked = 5, kStateWaiting = 6;

constexpr double kCentred = 0.02;    // from a grid point [m]
constexpr double kOnGrid = 0.001;    // where a robot takes itself to stand on a grid point [m]
constexpr int kInsists = 3;          // refusals after which a path can't begin where it does
constexpr int kRefuges = 1;          // cells around a robot in which it may come back to the grid
constexpr double kFindsBack = 30;    // time in which one that was pushed does [s]
constexpr double kReach = 0.43;      // of a robot with its load, from its centre along x and y [m]
constexpr double kHalf = 0.4;        // of the length and the width of a load [m]
constexpr double kSweep = 0.58;      // around a load that turns, with a little room [m]
constexpr double kRoom = 1.2;        // that one takes which turns and drives back to the grid [m]
constexpr double kTurnsSoon = 0.35;  // from a corner, where what comes after it is released [m]
constexpr double kUnanswered = 0.5;  // after which something is sent again [s]
constexpr double kSettled = 1;       // after which nothing that was sent is on its way any more [s]
constexpr double kBlockedFor = 1;    // after which a robot is sent another way [s]
constexpr double kStalledFor = 5;    // after which a robot is taken to be broken [s]
constexpr double kClosedFor = 3;     // that what was in its way is taken to stay [s]
constexpr double kStandstill = 0.01;             // [m/s]
constexpr double kAligned = 0.05;                // with the way ahead [rad]
constexpr double kQuarter = 1.5707963267948966;  // of a turn [rad]
constexpr int kNobody = -1;

/// How long a run from rest to rest takes [s].
double runTime(double metres, const Motion& motion) {
  const double ramps = motion.speed * motion.speed / motion.acceleration;
  if (metres >= ramps) return metres / motion.speed + motion.speed / motion.acceleration;
  return 2 * std::sqrt(metres / motion.acceleration);
}

/// When a robot that accelerates from `speed` has come so far [s]; `speed` becomes what it has
/// then.
double timeUntil(double metres, const Motion& motion, double& speed) {
  const double begin = speed;
  const double end = std::sqrt(begin * begin + 2 * motion.acceleration * metres);
  if (end <= motion.speed) {
    speed = end;
    return (end - begin) / motion.acceleration;
  }
  speed = motion.speed;
  const double ramp = (speed * speed - begin * begin) / (2 * motion.acceleration);
  return std::max(0.0, speed - begin) / motion.acceleration + (metres - ramp) / speed;
}

/// From one end to the other, no further apart than a cell.
std::vector<double> marks(double from, double to, double spacing) {
  const int gaps = static_cast<int>(std::ceil((to - from) / spacing));
  std::vector<double> marks;
  for (int i = 0; i <= gaps; ++i) marks.push_back(from + (to - from) * i / gaps);
  return marks;
}

}  // namespace

Execution::Execution(const Floor& floor, const Motion& motion)
    : floor_(floor),
      motion_(motion),
      holder_(floor.size(), kNobody),
      next_claim_(floor.size(), -1),
      closed_until_(floor.size(), -1),
      is_in_zone_(floor.size(), 0) {}

void Execution::observe(double time, const std::vector<Report>& reports) {
  const double elapsed = std::max(0.0, time - now_);
  now_ = time;
  if (reports.size() != courses_.size()) {
    std::fill(holder_.begin(), holder_.end(), kNobody);
    courses_.assign(reports.size(), {});
    claims_.clear();
    std::fill(next_claim_.begin(), next_claim_.end(), -1);
    members_.clear();
  }
  reports_ = reports;
  const int robots = static_cast<int>(reports.size());
  // Who drives as told first: others get only what those have not got.
  for (int robot = 0; robot < robots; ++robot) {
    Course& course = courses_[robot];
    if (course.is_member && !reports[robot].is_controlled && isOver(robot)) dismiss(robot);
    if (!course.is_member) continue;
    follow(robot);
    if (course.is_member) keepAround(robot);
    measure(robot, elapsed);
  }
  for (int robot = 0; robot < robots; ++robot) {
    if (courses_[robot].is_member) continue;
    courses_[robot].still_since = now_;
    vacate(robot);
    if (reports[robot].is_controlled) {
      admit(robot);
    } else {
      courses_[robot].recovery = {};
    }
    courses_[robot].is_member ? keepAround(robot) : occupy(robot);
  }
  findTight();
}

void Execution::setWork(const std::vector<std::uint8_t>& busy,
                        const std::vector<std::uint8_t>& loaded) {
  for (int robot = 0; robot < robots(); ++robot) {
    reports_[robot].is_busy = busy.at(robot);
    reports_[robot].is_loaded = loaded.at(robot);
  }
}

/// It drives as it is told from now on, if it stands in a cell that nobody else has.
void Execution::admit(int robot) {
  Course& course = courses_[robot];
  const Report& report = reports_[robot];
  if (report.status != kStatusIdle) return;
  Cell at = cellAt(report.x, report.y);
  if (at == kNowhere || !floor_.isPassable(at)) {
    if (course.recovery.since < 0) course.recovery.since = now_;
    at = refuge(robot);
  }
  if (at == kNowhere || holder_[at] != kNobody) return;
  vacate(robot);
  renew(robot);
  course.id = std::max(course.id, report.path_id);
  course.is_member = true;
  course.at = at;
  course.cells = {at};
  course.is_off = true;
  course.still_since = course.moved = now_;
  course.run_heading = headingOf(robot);
  hold(at, robot);
}

/// Whether nothing that it was released is driven any more.
bool Execution::isOver(int robot) const {
  const Course& course = courses_[robot];
  const Report& report = reports_[robot];
  if (!course.is_active) return true;
  if (report.status != kStatusIdle && report.path_id == course.id) return false;
  return course.is_accepted || now_ - course.sent > kSettled;
}

void Execution::dismiss(int robot) {
  Course& course = courses_[robot];
  vacate(robot);
  for (const Cell cell : course.cells) free(cell, robot);
  renew(robot);
}

/// Forgets all of its way but that it has to find back, while it is to be told where to.
void Execution::renew(int robot) {
  Course next;
  next.id = courses_[robot].id;
  if (reports_[robot].is_controlled) next.recovery = std::move(courses_[robot].recovery);
  courses_[robot] = std::move(next);
}

/// An obstacle has what it stands on, and what it drives onto next.
void Execution::occupy(int robot) {
  courses_[robot].at = cellAt(reports_[robot].x, reports_[robot].y);
  cover(robot);
}

/// One that was pushed off the middle of its cell has all that it stands on, until it is back.
void Execution::keepAround(int robot) {
  Course& course = courses_[robot];
  const bool rests = !course.is_active && reports_[robot].status == kStatusIdle;
  if (isBack(robot)) {
    course.is_astray = false;
    course.recovery = {};
  } else if (rests) {
    course.is_astray = true;
  }
  vacate(robot);
  if (course.is_astray) cover(robot);
}

void Execution::cover(int robot) {
  Course& course = courses_[robot];
  const Report& report = reports_[robot];
  const bool is_trying = course.recovery.since >= 0 && !isLost(robot);  // between attempts, too
  const bool is_coming_back = course.is_astray && (course.is_active || is_trying);
  const double reach = (is_coming_back ? kRoom : kReach) * motion_.spacing;
  const double ahead = 0.7 * motion_.spacing;
  const double speed = std::hypot(report.vx, report.vy);
  const double dx = speed > kStandstill ? ahead * report.vx / speed : 0;
  const double dy = speed > kStandstill ? ahead * report.vy / speed : 0;
  for (const double x :
       marks(std::min(0.0, dx) - reach, std::max(0.0, dx) + reach, motion_.spacing)) {
    for (const double y :
         marks(std::min(0.0, dy) - reach, std::max(0.0, dy) + reach, motion_.spacing)) {
      const Cell cell = cellAt(report.x + x, report.y + y);
      if (cell == kNowhere || holder_[cell] != kNobody) continue;
      hold(cell, robot);
      course.occupied.push_back(cell);
    }
  }
}

/// Robots drive past one that stands askew with room to spare, but a corner of its load may be
/// where theirs turn.
void Execution::findTight() {
  tight_.clear();
  for (int robot = 0; robot < robots(); ++robot) {
    const Cell at = cellAt(reports_[robot].x, reports_[robot].y);
    if (at == kNowhere || !isAskew(robot)) continue;
    for (int heading = 0; heading < kHeadings; ++heading) {
      const Cell beside = floor_.beside(at, heading);
      if (beside == kNowhere) continue;
      for (const Cell cell : {beside, floor_.beside(beside, heading + 1)}) {
        if (cell == kNowhere || holder_[cell] == robot) continue;  // closed anyway
        if (isInReach(robot, cell)) tight_.push_back(cell);
      }
    }
  }
  std::sort(tight_.begin(), tight_.end());
  tight_.erase(std::unique(tight_.begin(), tight_.end()), tight_.end());
}

bool Execution::isAskew(int robot) const {
  const Course& course = courses_[robot];
  if (course.is_member && !course.is_astray) return false;
  return !isCentred(robot, kCentred) || !isSquare(robot);
}

/// Whether a load that is turned in that cell would touch the robot's.
bool Execution::isInReach(int robot, Cell cell) const {
  const Report& report = reports_[robot];
  const double c = std::cos(report.yaw), s = std::sin(report.yaw);
  const double dx = xOf(cell) - report.x, dy = yOf(cell) - report.y;
  const double along = std::max(0.0, std::abs(c * dx + s * dy) - kHalf);
  const double across = std::max(0.0, std::abs(c * dy - s * dx) - kHalf);
  return std::hypot(along, across) < kSweep;
}

void Execution::vacate(int robot) {
  for (const Cell cell : courses_[robot].occupied) free(cell, robot);
  courses_[robot].occupied.clear();
}

void Execution::free(Cell cell, int robot) {
  if (holder_[cell] == robot) holder_[cell] = kNobody;
}

/// Takes in how far it has come.
void Execution::follow(int robot) {
  Course& course = courses_[robot];
  const Report& report = reports_[robot];
  if (course.turning != kNowhere && hasTurned(robot)) course.turning = kNowhere;
  if (!course.is_active) {
    // Somebody else has moved it.
    const Cell at = cellAt(report.x, report.y);
    if (at != course.at && !course.is_astray) {
      dismiss(robot);
      admit(robot);
    }
    return;
  }
  const bool is_reported = report.path_id == course.id;
  if (report.status == kStatusIdle) {
    // What was refused may still have a twin under way, and that may be accepted; by one that is
    // not heard it may have been.
    const bool is_settled = now_ - course.sent > kSettled && !isBroken(robot);
    const bool is_dead = course.is_refused && is_settled;
    if (course.is_accepted || is_reported || is_dead) finish(robot);
    return;
  }
  if (!is_reported) return;
  course.is_accepted = true;
  course.is_refused = false;
  course.refusals = 0;
  pass(robot, static_cast<int>(report.reached), static_cast<int>(report.left));
  if (report.state == kStateBlocked) {
    if (course.blocked_since < 0) {
      course.blocked_since = now_;
      ++blocked_;
    }
    if (now_ - course.blocked_since >= kBlockedFor) withdraw(robot);
  } else {
    course.blocked_since = -1;
    if (course.is_withdrawn) withdraw(robot);
  }
}

/// Whether it is around the corner that it was released around.
bool Execution::hasTurned(int robot) const {
  const Course& course = courses_[robot];
  const auto corner = std::find(course.cells.rbegin(), course.cells.rend(), course.turning);
  const auto point = course.cells.rend() - corner - 1;
  if (point + 1 >= static_cast<int>(course.cells.size())) return true;
  if (course.reached < point + 1) return false;
  const double yaw = kQuarter * headingTo(course.turning, course.cells[point + 1]);
  return std::abs(std::remainder(reports_[robot].yaw - yaw, 4 * kQuarter)) < kAligned;
}

void Execution::pass(int robot, int reached, int left) {
  Course& course = courses_[robot];
  const int points = static_cast<int>(course.cells.size());
  // Who has left a cell wholly is in the next one, before it comes to the middle of that.
  course.is_short = left >= reached;
  reached = std::clamp(std::max(reached, left + 1), course.reached, points);
  for (int point = course.reached; point < reached; ++point) {
    const int heading = headingTo(course.cells[point - 1], course.cells[point]);
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
      free(course.cells[point], robot);
    }
  }
  course.left = left;
}

/// Its path is over, wherever that is: it holds only where it stands.
void Execution::finish(int robot) {
  Course& course = courses_[robot];
  const Report& report = reports_[robot];
  const Cell at = cellAt(report.x, report.y);
  if (course.is_refused && (course.is_astray || ++course.refusals >= kInsists)) {
    course.recovery.refused.push_back(course.cells.front());
  } else if (course.is_accepted) {
    course.recovery.refused.clear();
  }
  if (at == course.cells.back()) pass(robot, static_cast<int>(course.cells.size()), 0);
  const bool was_withdrawn = course.is_withdrawn;
  vacate(robot);
  for (const Cell cell : course.cells) free(cell, robot);
  const bool is_held = at != kNowhere && holder_[at] != kNobody && holder_[at] != robot;
  if (at == kNowhere || is_held || !floor_.isPassable(at)) return dismiss(robot);
  if (at != course.cells.back() || was_withdrawn) {
    course.is_off = true;
    course.plan.clear();
  }
  hold(at, robot);
  course.at = at;
  course.cells = {at};
  course.reached = 1;
  course.left = 0;
  course.is_active = course.is_accepted = course.is_refused = course.is_withdrawn = false;
  course.is_short = false;
  course.turning = kNowhere;
  course.blocked_since = -1;
}

void Execution::refused(int robot) {
  if (robot < 0 || robot >= static_cast<int>(courses_.size())) return;
  Course& course = courses_[robot];
  if (course.is_member && course.is_active && !course.is_accepted) course.is_refused = true;
}

/// Something stands in its way: the path is to end where it can still stop. It keeps its cells
/// until it says that it has. Said again until then: where it drives on meanwhile that is refused.
void Execution::withdraw(int robot) {
  Course& course = courses_[robot];
  const int keep =
      std::min<int>(course.cells.size(), course.reached + (isCentred(robot, kCentred) ? 0 : 1));
  const bool is_blocked = reports_[robot].state == kStateBlocked;
  if (is_blocked && keep < static_cast<int>(course.cells.size())) {
    close(course.cells[keep], now_ + kClosedFor);
  }
  if (course.is_withdrawn && now_ - course.sent < kUnanswered) return;
  course.is_withdrawn = true;
  course.plan.clear();
  course.is_off = true;
  releaseUpTo(robot, keep);
}

/// So many points; the last is told once more, so that what was planned beyond is cut off.
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

/// Sums up what it has driven straight on.
void Execution::endRun(Course& course) const {
  if (course.run > 0) course.journey.alone += runTime(course.run * motion_.spacing, motion_);
  course.run = 0;
}

/// Whether it stands because the plan has it wait, or after one in its way that stands as well.
bool Execution::waitsAsPlanned(int robot) const {
  const Course& course = courses_[robot];
  if (course.waits_by_plan || course.waits_for == kNobody) return course.waits_by_plan;
  return speedOf(course.waits_for) < kStandstill;
}

void Execution::measure(int robot, double elapsed) {
  Course& course = courses_[robot];
  if (!course.is_member) return;
  const bool is_still = speedOf(robot) < kStandstill && reports_[robot].state != kStateRotating;
  if (!course.travels || !is_still) course.still_since = now_;
  if (!is_still || course.reached == static_cast<int>(course.cells.size())) course.moved = now_;
  if (!course.travels) return;
  course.journey.driven += elapsed;
  if (!is_still || toGo(robot) > kCentred || !waitsAsPlanned(robot)) return;
  course.journey.planned += elapsed;
  endRun(course);
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

Fleet Execution::fleet(const std::vector<Cell>& goal, const std::vector<Cell>& home, int horizon) {
  members_.clear();
  asked_ = {};
  asked_.committed_ticks = horizon;
  const int robots = static_cast<int>(courses_.size());
  for (int robot = 0; robot < robots; ++robot) {
    Course& course = courses_[robot];
    if (!course.is_member || !reports_[robot].is_controlled || isStalled(robot)) continue;
    members_.push_back(robot);
    asked_.cell.push_back(course.at);
    asked_.heading.push_back(headingOf(robot));
    asked_.goal.push_back(goal[robot]);
    asked_.home.push_back(home[robot]);
    asked_.loaded.push_back(reports_[robot].is_loaded);
    asked_.committed.resize(asked_.committed.size() + horizon, Fleet::kFree);
    commit(robot, &asked_.committed[asked_.committed.size() - horizon], horizon);
    course.travels = goal[robot] != kNowhere && goal[robot] != course.at;
    course.committed = static_cast<int>(course.cells.size()) - course.reached;
    course.granted.clear();
    course.is_off = false;
  }
  asked_.closed = closed();
  asked_.units = units_;
  asked_.tight = tight_;
  return asked_;
}

std::vector<Cell> Execution::closed() const {
  std::vector<Cell> closed = zone_;
  for (const Cell cell : closing_) {
    if (closed_until_[cell] > now_) closed.push_back(cell);
  }
  for (int robot = 0; robot < robots(); ++robot) {
    const Course& course = courses_[robot];
    closed.insert(closed.end(), course.occupied.begin(), course.occupied.end());
    if (!course.is_member || (reports_[robot].is_controlled && !isStalled(robot))) continue;
    closed.insert(closed.end(), course.cells.begin() + course.left, course.cells.end());
  }
  std::sort(closed.begin(), closed.end());
  closed.erase(std::unique(closed.begin(), closed.end()), closed.end());
  return closed;
}

void Execution::setZone(std::vector<Cell> cells) {
  for (const Cell cell : zone_) is_in_zone_[cell] = 0;
  cells.erase(std::remove_if(cells.begin(), cells.end(), [this](Cell c) { return !floor_.has(c); }),
              cells.end());
  zone_ = std::move(cells);
  for (const Cell cell : zone_) is_in_zone_[cell] = 1;
}

void Execution::close(Cell cell, double until) {
  if (!floor_.has(cell)) return;
  if (std::find(closing_.begin(), closing_.end(), cell) == closing_.end()) closing_.push_back(cell);
  closed_until_[cell] = std::max(closed_until_[cell], until);
}

void Execution::recall(Cell cell) {
  const int robot = floor_.has(cell) ? holder_[cell] : kNobody;
  if (robot == kNobody) return;
  const Course& course = courses_[robot];
  const auto ahead = course.cells.begin() + course.reached;
  const bool is_ahead = std::find(ahead, course.cells.end(), cell) != course.cells.end();
  if (is_ahead && course.is_accepted && !course.is_withdrawn) withdraw(robot);
}

/// What it has been released, as actions: turns, drives, and waiting where it takes longer.
void Execution::commit(int robot, std::uint8_t* row, int horizon) const {
  const Course& course = courses_[robot];
  int tick = 0;
  const auto add = [&](Action action) {
    if (tick < horizon) row[tick++] = static_cast<std::uint8_t>(action);
  };
  if (reports_[robot].is_busy) {
    while (tick < horizon) add(Action::kWait);
    return;
  }
  int heading = headingOf(robot);
  double time = 0, speed = speedOf(robot);
  for (int point = course.reached; point < static_cast<int>(course.cells.size()); ++point) {
    const Cell from = course.cells[point - 1], to = course.cells[point];
    const int towards = headingTo(from, to);
    const int quarters = (towards - heading) & 3;
    for (int turn = 0; turn < (quarters == 3 ? 1 : quarters); ++turn) {
      add(quarters == 3 ? Action::kTurnNegative : Action::kTurnPositive);
      time += motion_.quarter;
      speed = 0;
    }
    heading = towards;
    const Report& report = reports_[robot];
    const double metres = point > course.reached
                              ? motion_.spacing
                              : std::abs(xOf(to) - report.x) + std::abs(yOf(to) - report.y);
    time += timeUntil(metres, motion_, speed);
    while (tick + 1 < std::lround(time / motion_.tick()) && tick < horizon) add(Action::kWait);
    add(Action::kForward);
  }
}

void Execution::adopt(const Plan& plan) {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    if (courses_[members_[i]].is_member) take(members_[i], plan, static_cast<int>(i));
  }
  queueUp();
}

/// What the plan has for it beyond what it is released by now.
void Execution::take(int robot, const Plan& plan, int index) {
  Course& course = courses_[robot];
  course.plan.clear();
  course.waits_by_plan = false;
  if (course.is_off || course.is_withdrawn) return;
  State state{asked_.cell[index], asked_.heading[index]};
  std::vector<Step> steps;
  for (int tick = 0; tick < plan.horizon; ++tick) {
    const Action action = plan.at(index, tick);
    state = after(floor_, state, action);
    if (action == Action::kForward && state.cell != kNowhere) steps.push_back({state.cell, tick});
  }
  const std::size_t known = course.committed + course.granted.size();
  for (std::size_t i = course.committed; i < known; ++i) {
    if (i >= steps.size() || steps[i].cell != course.granted[i - course.committed]) return;
  }
  if (steps.size() < known) return;
  course.plan.assign(steps.begin() + known, steps.end());
  // A robot that is to turn and to wait then waits first: it turns when it may drive on.
  const int from = std::max(asked_.commitments(index), known > 0 ? steps[known - 1].tick + 1 : 0);
  const int until = course.plan.empty() ? plan.horizon : course.plan.front().tick;
  for (int tick = from; tick < until; ++tick) {
    if (plan.at(index, tick) == Action::kWait) course.waits_by_plan = true;
  }
}

/// For each cell, who passes it first.
void Execution::queueUp() {
  for (const Claim& claim : claims_) next_claim_[claim.cell] = -1;
  claims_.clear();
  for (const int robot : members_) {
    for (const Step& step : courses_[robot].plan) claims_.push_back({step.cell, step.tick, robot});
  }
  std::sort(claims_.begin(), claims_.end(), [](const Claim& one, const Claim& other) {
    if (one.cell != other.cell) return one.cell < other.cell;
    return one.tick != other.tick ? one.tick < other.tick : one.robot < other.robot;
  });
  for (std::size_t i = claims_.size(); i-- > 0;) next_claim_[claims_[i].cell] = static_cast<int>(i);
}

/// Who comes next by the plan; kNobody.
int Execution::firstClaimant(Cell cell) {
  int& next = next_claim_[cell];
  while (next >= 0) {
    const Claim& claim = claims_[next];
    const Course& course = courses_[claim.robot];
    // Its plan's first step to this cell, if it has that step still before it.
    const auto has = [&](const Step& step) { return step.cell == cell && step.tick == claim.tick; };
    if (std::any_of(course.plan.begin(), course.plan.end(), has)) return claim.robot;
    const std::size_t following = next + 1;
    next = following < claims_.size() && claims_[following].cell == cell
               ? static_cast<int>(following)
               : -1;
  }
  return kNobody;
}

Releases Execution::release() {
  for (int robot = 0; robot < robots(); ++robot) {
    if (courses_[robot].is_member) extend(robot);
  }
  return std::exchange(releases_, {});
}

void Execution::extend(int robot) {
  Course& course = courses_[robot];
  course.waits_for = kNobody;
  if (reports_[robot].is_busy || !reports_[robot].is_controlled || course.is_withdrawn) return;
  if (isBroken(robot)) return;
  if (course.is_astray) return recentre(robot);
  const int before = static_cast<int>(course.cells.size());
  while (!course.plan.empty() && needs(robot)) {
    const Cell cell = course.plan.front().cell;
    const Cell tip = course.cells.back();
    const int arrival =
        course.cells.size() > 1 && course.reached < static_cast<int>(course.cells.size())
            ? headingTo(course.cells[course.cells.size() - 2], tip)
            : headingOf(robot);
    const bool turns = headingTo(tip, cell) != arrival;
    if (turns && !mayTurn(robot)) break;
    if (!mayHave(robot, cell)) break;
    if (turns) course.turning = tip;
    hold(cell, robot);
    course.cells.push_back(cell);
    course.granted.push_back(cell);
    course.plan.erase(course.plan.begin());
  }
  const bool is_new = static_cast<int>(course.cells.size()) > before;
  if (is_new && !course.is_active) {
    ++course.id;
    course.is_active = true;
    course.is_accepted = false;
    send(robot, 0);
  } else if (is_new) {
    send(robot, course.is_accepted ? before : 0);
  } else if (course.is_active && now_ - course.sent > kUnanswered) {
    const bool is_waiting = course.is_accepted && reports_[robot].state == kStateWaiting &&
                            course.reached < static_cast<int>(course.cells.size());
    if (is_waiting) send(robot, course.reached);
    if (isAtEnd(robot)) releaseUpTo(robot, static_cast<int>(course.cells.size()));
    if (!course.is_accepted && !course.is_refused) send(robot, 0);
  }
}

/// Whether it waits to be sent on though it has nowhere to go.
bool Execution::isAtEnd(int robot) const {
  const Course& course = courses_[robot];
  return course.is_accepted && !course.travels && course.plan.empty() &&
         reports_[robot].state == kStateWaiting &&
         course.reached == static_cast<int>(course.cells.size());
}

/// A path begins in the middle of a cell: one without a way leads there. Which cells it has room in
/// to turn is the robot's to say.
void Execution::recentre(int robot) {
  Course& course = courses_[robot];
  if (course.is_accepted || course.is_refused || isLost(robot)) return;
  if (course.is_active && now_ - course.sent <= kUnanswered) return;
  if (course.recovery.since < 0) course.recovery.since = now_;
  if (!course.is_active) {
    const Cell back = refuge(robot);
    if (back == kNowhere) {
      course.recovery.refused.clear();  // perhaps there is room by now
      return;
    }
    vacate(robot);
    free(course.at, robot);
    hold(back, robot);
    course.at = back;
    course.cells = {back};
    cover(robot);
    ++course.id;
  }
  course.is_active = true;
  course.plan.clear();
  course.is_off = true;
  send(robot, 0);
}

/// The nearest cell in which a path can begin, of those that it has not refused; kNowhere.
Cell Execution::refuge(int robot) const {
  const Report& report = reports_[robot];
  Cell nearest = kNowhere;
  double least = 0;
  for (int row = -kRefuges; row <= kRefuges; ++row) {
    for (int column = -kRefuges; column <= kRefuges; ++column) {
      const Cell cell =
          cellAt(report.x + column * motion_.spacing, report.y + row * motion_.spacing);
      if (cell == kNowhere || !mayRest(robot, cell)) continue;
      const double far = std::hypot(xOf(cell) - report.x, yOf(cell) - report.y);
      if (nearest != kNowhere && far >= least) continue;
      nearest = cell;
      least = far;
    }
  }
  return nearest;
}

bool Execution::mayRest(int robot, Cell cell) const {
  const Course& course = courses_[robot];
  if (!floor_.isPassable(cell) || closed_until_[cell] > now_) return false;
  if (holder_[cell] != kNobody && holder_[cell] != robot) return false;
  const std::vector<Cell>& refused = course.recovery.refused;
  if (std::find(refused.begin(), refused.end(), cell) != refused.end()) return false;
  if (!reports_[robot].is_loaded || cell == course.at) return true;
  return !floor_.isStorage(cell) && std::find(units_.begin(), units_.end(), cell) == units_.end();
}

bool Execution::mayHave(int robot, Cell cell) {
  if (is_in_zone_[cell] != 0 && is_in_zone_[courses_[robot].cells.back()] == 0) return false;
  const int holder = holder_[cell];
  if (holder != kNobody && holder != robot) {
    courses_[robot].waits_for = holder;
    return false;
  }
  const int first = firstClaimant(cell);
  if (first == robot) return true;
  courses_[robot].waits_for = first;
  return false;
}

/// Whether it would have to brake before the next release.
bool Execution::needs(int robot) const {
  const double latency = motion_.latency;
  const double soon = std::min(motion_.speed, speedOf(robot) + motion_.acceleration * latency);
  const double way = soon * latency + soon * soon / (2 * motion_.acceleration);
  return toGo(robot) < way;
}

/// Two side by side, one with a load, must not turn at once, nor a load beside one that stands
/// askew, and nobody is released around a corner before it comes to it.
bool Execution::mayTurn(int robot) const {
  const Cell tip = courses_[robot].cells.back();
  if (toGo(robot) > kTurnsSoon) return false;
  const bool is_tight = std::binary_search(tight_.begin(), tight_.end(), tip);
  if (is_tight && reports_[robot].is_loaded) return false;
  for (int heading = 0; heading < kHeadings; ++heading) {
    const Cell beside = floor_.beside(tip, heading);
    const int other = beside == kNowhere ? kNobody : holder_[beside];
    if (other == kNobody || other == robot || !keepsFromTurning(other, beside, tip)) continue;
    if (reports_[robot].is_loaded || reports_[other].is_loaded) return false;
  }
  return true;
}

/// Whether one in a cell turns there, or has just come there `from` the cell beside it: whoever
/// turns in that would touch it, as long as it is short of the middle.
bool Execution::keepsFromTurning(int robot, Cell in, Cell from) const {
  const Course& course = courses_[robot];
  if (course.turning == in) return true;
  return course.is_short && course.at == in && course.cells[course.reached - 2] == from;
}

/// Points from `first` on, and what comes next by the plan.
void Execution::send(int robot, int first) {
  Course& course = courses_[robot];
  const int released = static_cast<int>(course.cells.size());
  releases_.robot.push_back(robot);
  releases_.path_id.push_back(course.id);
  releases_.first.push_back(first);
  releases_.released.push_back(released);
  releases_.cells.insert(releases_.cells.end(), course.cells.begin() + first, course.cells.end());
  std::uint32_t points = released - first;
  for (const Step& step : course.plan) {
    releases_.cells.push_back(step.cell);
    ++points;
  }
  releases_.points.push_back(points);
  course.sent = now_;
}

bool Execution::isForeign(int robot) const {
  const Course& course = courses_.at(robot);
  const Report& report = reports_[robot];
  if (report.status == kStatusIdle) return false;
  // Who lifts, or is at work, does not drive.
  if (report.is_busy && report.state != kStateMovingX && report.state != kStateMovingY)
    return false;
  // A late copy of a path that was given up is its own still.
  if (!course.is_active) return report.path_id == 0 || report.path_id != course.id;
  return (course.is_accepted || course.is_refused) && report.path_id != course.id;
}

bool Execution::isStalled(int robot) const {
  const Course& course = courses_.at(robot);
  return isBroken(robot) || (course.is_active && now_ - course.moved > kStalledFor);
}

bool Execution::isLost(int robot) const {
  const double since = courses_.at(robot).recovery.since;
  return since >= 0 && now_ - since > kFindsBack;
}

bool Execution::stands(int robot) const {
  const Course& course = courses_.at(robot);
  return course.is_member && !course.is_active && !course.is_astray;
}

bool Execution::isClosing() const {
  const auto is_closed = [this](Cell cell) { return closed_until_[cell] > now_; };
  return std::any_of(closing_.begin(), closing_.end(), is_closed);
}

std::vector<Cell> Execution::released(int robot) const {
  const Course& course = courses_.at(robot);
  if (!course.is_member) return course.occupied;
  return {course.cells.begin() + course.left, course.cells.end()};
}

std::vector<Cell> Execution::planned(int robot) const {
  std::vector<Cell> cells;
  for (const Step& step : courses_.at(robot).plan) cells.push_back(step.cell);
  return cells;
}

Cell Execution::cellAt(double x, double y) const {
  const double column = std::round((x - motion_.origin_x) / motion_.spacing);
  const double row = std::round((y - motion_.origin_y) / motion_.spacing);
  const bool is_inside =
      column >= 0 && column < floor_.width() && row >= 0 && row < floor_.height();
  return is_inside ? static_cast<Cell>(row) * floor_.width() + static_cast<Cell>(column) : kNowhere;
}

Heading Execution::headingOf(int robot) const {
  return turned(static_cast<int>(std::lround(reports_[robot].yaw / kQuarter)), 0);
}

/// From a cell to one beside it.
int Execution::headingTo(Cell from, Cell to) const {
  const int step = to - from;
  if (step == floor_.width()) return 1;
  if (step == -floor_.width()) return 3;
  return step > 0 ? 0 : 2;
}

double Execution::speedOf(int robot) const {
  return std::hypot(reports_[robot].vx, reports_[robot].vy);
}

/// To the last cell that it is released [m].
double Execution::toGo(int robot) const {
  const Course& course = courses_[robot];
  const int points = static_cast<int>(course.cells.size());
  if (course.reached >= points) return 0;
  const Cell next = course.cells[course.reached];
  const Report& report = reports_[robot];
  return std::abs(xOf(next) - report.x) + std::abs(yOf(next) - report.y) +
         (points - course.reached - 1) * motion_.spacing;
}

bool Execution::isCentred(int robot, double within) const {
  const Report& report = reports_[robot];
  const Cell at = courses_[robot].at;
  return std::hypot(xOf(at) - report.x, yOf(at) - report.y) < within;
}

/// Whether a path can begin where it stands. One that refuses to says itself where that is.
bool Execution::isBack(int robot) const {
  const bool has_refused = !courses_[robot].recovery.refused.empty();
  return isCentred(robot, has_refused ? kOnGrid : kCentred) && isSquare(robot);
}

bool Execution::isSquare(int robot) const {
  return std::abs(std::remainder(reports_[robot].yaw, kQuarter)) < kAligned;
}

}  // namespace fleet
