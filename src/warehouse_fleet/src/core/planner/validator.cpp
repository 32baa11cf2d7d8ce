// SPDX-License-Identifier: Apache-2.0
#include "warehouse_fleet/validator.h"

#include <algorithm>
#include <unordered_map>

namespace fleet {
namespace {

using Kind = Violation::Kind;
using Standing = std::unordered_map<Cell, int>;

/// Drives the plan tick by tick and notes violations.
class PlanDrive {
 public:
  PlanDrive(const Floor& floor, const Fleet& fleet, const Plan& plan, const Rules& rules)
      : floor_(floor), fleet_(fleet), plan_(plan), rules_(rules) {
    for (const Cell cell : fleet.closed) closed_[cell] = 1;
    for (const Cell cell : fleet.zone) zone_[cell] = 1;
    for (int robot = 0; robot < fleet.size(); ++robot) {
      now_.push_back({fleet.cell[robot], fleet.heading[robot]});
    }
  }

  void tick(int tick) {
    tick_ = tick;
    then_.clear();
    for (int robot = 0; robot < fleet_.size(); ++robot) then_.push_back(drive(robot));
    stood_.clear();
    for (int robot = 0; robot < fleet_.size(); ++robot) stood_.emplace(now_[robot].cell, robot);
    vertices();
    for (int robot = 0; robot < fleet_.size(); ++robot) {
      follow(robot);
      if (!rules_.turning) turn(robot);
    }
    now_ = then_;
  }

  std::vector<Violation> violations;

 private:
  void note(Kind kind, std::vector<int> robots, Cell cell) {
    violations.push_back({kind, tick_, std::move(robots), cell});
  }

  GridPose drive(int robot) {
    const GridPose state = now_[robot];
    const Action action = plan_.at(robot, tick_);
    if (fleet_.isStopped(robot) && action != Action::kWait) {
      note(Kind::kStopped, {robot}, state.cell);
    }
    if (!fleet_.isStopped(robot) && tick_ < fleet_.commitments(robot) &&
        action != fleet_.commitment(robot, tick_)) {
      note(Kind::kCommitment, {robot}, state.cell);
    }
    if (action != Action::kForward) return after(floor_, state, action);
    const Cell to = floor_.next(Deck::kUnder, state.cell, state.heading);
    const bool is_barred = to != kNowhere && fleet_.isLoaded(robot) && floor_.isStorage(to) &&
                           to != fleet_.homeOf(robot);
    const bool is_fenced = zone_.count(to) && !zone_.count(state.cell);
    const bool is_open = !is_barred && !is_fenced && !closed_.count(to);
    if (to != kNowhere && is_open) return {to, state.heading};
    note(Kind::kWall, {robot}, state.cell);
    return state;
  }

  void vertices() {
    Standing standing;
    for (int robot = 0; robot < fleet_.size(); ++robot) {
      const auto [other, is_new] = standing.emplace(then_[robot].cell, robot);
      if (!is_new) note(Kind::kVertex, {other->second, robot}, then_[robot].cell);
    }
  }

  bool moves(int robot) const { return now_[robot].cell != then_[robot].cell; }

  /// Returns the robot that leaves the cell which this one enters; -1: none does.
  int leader(int robot) const {
    if (!moves(robot)) return -1;
    const auto other = stood_.find(then_[robot].cell);
    return other != stood_.end() && moves(other->second) ? other->second : -1;
  }

  void follow(int robot) {
    const int first = leader(robot);
    if (first < 0) return;
    if (leader(first) == robot) {
      if (robot < first) note(Kind::kSwap, {robot, first}, then_[robot].cell);
      return;
    }
    if (!rules_.following) note(Kind::kFollowing, {robot, first}, then_[robot].cell);
    if (rules_.rings) return;
    std::vector<int> ring = {robot};
    for (int next = first; next >= 0; next = leader(next)) {
      if (next == robot) return note(Kind::kRing, ring, then_[robot].cell);
      // Each ring is noted once, from its robot with the lowest number.
      if (next < robot || ring.size() > now_.size()) return;
      ring.push_back(next);
    }
  }

  bool sweeps(int robot) const {
    return fleet_.isLoaded(robot) && quarters(plan_.at(robot, tick_)) != 0;
  }

  void turn(int robot) {
    if (!sweeps(robot)) return;
    for (int heading = 0; heading < kHeadings; ++heading) {
      const auto other = stood_.find(floor_.beside(now_[robot].cell, heading));
      if (other == stood_.end() || other->second <= robot || !sweeps(other->second)) continue;
      note(Kind::kTurning, {robot, other->second}, now_[robot].cell);
    }
  }

  const Floor& floor_;
  const Fleet& fleet_;
  const Plan& plan_;
  const Rules rules_;
  std::unordered_map<Cell, int> closed_, zone_;
  int tick_ = 0;
  std::vector<GridPose> now_, then_;
  Standing stood_;
};

std::string list(const std::vector<int>& robots, const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < robots.size(); ++i) {
    if (i > 0) text += i + 1 == robots.size() ? " and " : ", ";
    text += names.empty() ? "robot " + std::to_string(robots[i]) : names.at(robots[i]);
  }
  return text;
}

}  // namespace

std::vector<Violation> validate(const Floor& floor, const Fleet& fleet, const Plan& plan,
                                const Rules& rules, int ticks) {
  if (plan.horizon < 1 || static_cast<int>(plan.actions.size()) != fleet.size() * plan.horizon) {
    throw FloorError("a plan of " + std::to_string(plan.actions.size()) + " actions for " +
                     std::to_string(fleet.size()) + " robots and " + std::to_string(plan.horizon) +
                     " ticks; one a robot and tick was expected");
  }
  PlanDrive drive(floor, fleet, plan, rules);
  const int end = ticks < 0 ? plan.horizon : std::min(ticks, plan.horizon);
  for (int tick = 0; tick < end; ++tick) drive.tick(tick);
  return drive.violations;
}

std::string describe(const Violation& violation, const Floor& floor,
                     const std::vector<std::string>& names) {
  const std::string who = list(violation.robots, names), where = floor.name(violation.cell);
  const std::string when = " (tick " + std::to_string(violation.tick) + ")";
  switch (violation.kind) {
    case Kind::kWall:
      return who + " would drive out of " + where + " where there is no way" + when;
    case Kind::kVertex:
      return who + " would both be in " + where + when;
    case Kind::kSwap:
      return who + " would exchange their cells at " + where + when;
    case Kind::kRing:
      return who + " would move around in a ring at " + where + when;
    case Kind::kFollowing:
      return who + ": the first would enter " + where + " while the other leaves it" + when;
    case Kind::kTurning:
      return who + " would turn side by side with their units at " + where + when;
    case Kind::kCommitment:
      return who + " would not do at " + where + " what it is committed to" + when;
    default:
      return who + " is stopped at " + where + " and would move" + when;
  }
}

}  // namespace fleet
