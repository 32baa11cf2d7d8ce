// SPDX-License-Identifier: Apache-2.0
//
// Gives the state of the fleet to the planner, and adopts its plan.
#include <algorithm>
#include <cmath>
#include <utility>

#include "core/execution/execution_limits.h"
#include "warehouse_fleet/execution.h"

namespace fleet {

Fleet Execution::fleet(const std::vector<Cell>& goal, const std::vector<Cell>& home, int horizon) {
  members_.clear();
  asked_ = {};
  asked_.committed_ticks = horizon;
  const int robots = static_cast<int>(courses_.size());
  for (int robot = 0; robot < robots; ++robot) {
    Course& course = courses_[robot];
    if (!course.isMember() || !reports_[robot].is_controlled || isStalled(robot)) continue;
    members_.push_back(robot);
    asked_.cell.push_back(course.at);
    asked_.heading.push_back(headingOf(robot));
    asked_.goal.push_back(goal[robot]);
    asked_.home.push_back(home[robot]);
    asked_.loaded.push_back(reports_[robot].is_loaded);
    asked_.committed.resize(asked_.committed.size() + horizon, Fleet::kFree);
    commit(robot, &asked_.committed[asked_.committed.size() - horizon], horizon);
    course.travels = goal[robot] != kNowhere && goal[robot] != course.at;
    course.committed = course.points() - course.reached;
    course.granted.clear();
    course.plan_is_stale = false;
  }
  asked_.closed = closed();
  asked_.zone = holders_.closedZone();
  asked_.units = holders_.units();
  asked_.tight = tight_;
  return asked_;
}

/// Writes a robot's released path as actions: turns, drives, and waits where it takes longer.
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
  for (int point = course.reached; point < course.points(); ++point) {
    const Cell from = course.cells[point - 1], to = course.cells[point];
    const int towards = frame_.headingTo(from, to);
    const int quarters = (towards - heading) & 3;
    for (int turn = 0; turn < (quarters == 3 ? 1 : quarters); ++turn) {
      add(quarters == 3 ? Action::kTurnNegative : Action::kTurnPositive);
      time += motion_.quarter;
      speed = 0;
    }
    heading = towards;
    const Report& report = reports_[robot];
    const double metres = point > course.reached ? motion_.spacing
                                                 : std::abs(frame_.xOf(to) - report.x) +
                                                       std::abs(frame_.yOf(to) - report.y);
    time += timeUntil(metres, motion_, speed);
    while (tick + 1 < std::lround(time / motion_.tick()) && tick < horizon) add(Action::kWait);
    add(Action::kForward);
  }
}

std::vector<Cell> Execution::closed() const {
  std::vector<Cell> closed = holders_.closed(now_);
  for (int robot = 0; robot < robots(); ++robot) {
    const Course& course = courses_[robot];
    closed.insert(closed.end(), course.occupied.begin(), course.occupied.end());
    if (!course.isMember() || (reports_[robot].is_controlled && !isStalled(robot))) continue;
    closed.insert(closed.end(), course.cells.begin() + course.left, course.cells.end());
  }
  std::sort(closed.begin(), closed.end());
  closed.erase(std::unique(closed.begin(), closed.end()), closed.end());
  return closed;
}

void Execution::adopt(const Plan& plan) {
  for (std::size_t i = 0; i < members_.size(); ++i) {
    if (courses_[members_[i]].isMember()) take(members_[i], plan, static_cast<int>(i));
  }
  order_.set(members_, courses_);
}

void Execution::drive(std::vector<std::deque<Step>> plans) {
  members_.clear();
  for (int robot = 0; robot < robots(); ++robot) {
    Course& course = courses_[robot];
    course.plan = std::move(plans.at(robot));
    course.travels = !course.plan.empty();
    members_.push_back(robot);
  }
  order_.set(members_, courses_);
}

/// Takes a robot's part of the plan, beyond its released path.
void Execution::take(int robot, const Plan& plan, int index) {
  Course& course = courses_[robot];
  course.plan.clear();
  course.waits_by_plan = false;
  if (course.plan_is_stale || course.isWithdrawn()) return;
  GridPose state{asked_.cell[index], asked_.heading[index]};
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
  // A robot that is to turn and then wait waits first: it turns when it may drive on.
  const int from = std::max(asked_.commitments(index), known > 0 ? steps[known - 1].tick + 1 : 0);
  const int until = course.plan.empty() ? plan.horizon : course.plan.front().tick;
  for (int tick = from; tick < until; ++tick) {
    if (plan.at(index, tick) == Action::kWait) course.waits_by_plan = true;
  }
}

std::vector<Cell> Execution::released(int robot) const {
  const Course& course = courses_.at(robot);
  if (!course.isMember()) return course.occupied;
  return {course.cells.begin() + course.left, course.cells.end()};
}

int Execution::nextTick(int robot) const {
  const Course& course = courses_.at(robot);
  return course.plan.empty() ? -1 : course.plan.front().tick;
}

std::vector<Cell> Execution::planned(int robot) const {
  std::vector<Cell> cells;
  for (const Step& step : courses_.at(robot).plan) cells.push_back(step.cell);
  return cells;
}

}  // namespace fleet
