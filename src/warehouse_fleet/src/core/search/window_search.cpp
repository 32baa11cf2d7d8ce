// SPDX-License-Identifier: Apache-2.0
#include "core/search/window_search.h"

#include <algorithm>
#include <limits>

namespace fleet {
namespace {

constexpr int kMostGroup = 8;  // robots that lose their paths in an attempt

}  // namespace

WindowSearch::WindowSearch(const Floor& floor, const Rules& rules, int ticks,
                           const std::vector<Wish>& wishes, const Priorities& priorities,
                           const Candidates& candidates)
    : floor_(floor),
      rules_(rules),
      wishes_(wishes),
      priorities_(priorities),
      candidates_(candidates),
      paths_(floor, rules, ticks),
      route_(floor, candidates, paths_) {}

bool WindowSearch::canPlan() const {
  return rules_.following && std::none_of(wishes_.begin(), wishes_.end(), [](const Wish& wish) {
           return wish.stopped || wish.committed > 0 || wish.deck == Deck::kAisles;
         });
}

bool WindowSearch::inherit() {
  const int robots = static_cast<int>(wishes_.size());
  std::vector<WindowPath> rests(robots);
  bool is_punctual = has_paths_ && robots == static_cast<int>(is_chosen_.size());
  for (int robot = 0; robot < robots && is_punctual; ++robot) {
    rests[robot] = paths_.path(robot);
    auto& states = rests[robot].states;
    std::copy(states.begin() + 1, states.begin() + paths_.ticks() + 1, states.begin());
    is_punctual = states[0] == wishes_[robot].state && canDrive(wishes_[robot], rests[robot]);
  }
  has_paths_ = is_punctual;
  is_chosen_.assign(robots, 0);
  paths_.clear(robots);
  for (int robot = 0; robot < robots && is_punctual; ++robot) {
    rests[robot].cost = costOf(wishes_[robot], rests[robot]);
    paths_.place(robot, rests[robot]);
  }
  return is_punctual;
}

/// Returns whether a path leads along open edges, some of which may have closed or been kept.
bool WindowSearch::canDrive(const Wish& wish, const WindowPath& path) const {
  for (int tick = 0; tick < paths_.ticks(); ++tick) {
    const auto [cell, heading] = path.states[tick];
    const GridPose& to = path.states[tick + 1];
    if (to.cell != cell && candidates_.next(wish, cell, heading) != to.cell) return false;
    if (to.heading != heading && !candidates_.mayTurn(wish, cell)) return false;
  }
  return true;
}

void WindowSearch::adopt(const Reservations& reserved, int horizon) {
  const int robots = static_cast<int>(wishes_.size());
  paths_.clear(robots);
  for (int robot = 0; robot < robots; ++robot) {
    WindowPath path;
    path.states[0] = wishes_[robot].state;
    for (int tick = 0; tick < paths_.ticks(); ++tick) {
      const Action action = tick < horizon ? reserved.path(robot).actions[tick] : Action::kWait;
      path.states[tick + 1] = after(floor_, path.states[tick], action);
    }
    path.cost = costOf(wishes_[robot], path);
    paths_.place(robot, path);
  }
  has_paths_ = true;
}

void WindowSearch::write(Reservations& reserved, int horizon) const {
  const int robots = static_cast<int>(wishes_.size());
  for (int robot = 0; robot < robots; ++robot) reserved.remove(robot);
  for (int robot = 0; robot < robots; ++robot) {
    Path path;
    const auto& states = paths_.path(robot).states;
    path.cells[0] = states[0].cell;
    for (int tick = 0; tick < horizon; ++tick) {
      const GridPose &from = states[tick], &to = states[tick + 1];
      const int turn = (to.heading - from.heading) & 3;
      path.cells[tick + 1] = to.cell;
      path.actions[tick] = from.cell != to.cell ? Action::kForward
                           : turn == 1          ? Action::kTurnPositive
                           : turn == 3          ? Action::kTurnNegative
                                                : Action::kWait;
    }
    reserved.place(robot, path);
  }
}

/// Counts the cost as WindowRoute does.
int WindowSearch::costOf(const Wish& wish, const WindowPath& path) const {
  bool has_arrived = wish.goal == kNowhere || wish.goal == path.states[0].cell;
  int cost = 0, left = has_arrived ? 0 : candidates_.distance(wish, path.states[0]);
  for (int tick = 0; tick < paths_.ticks(); ++tick) {
    const GridPose &from = path.states[tick], &to = path.states[tick + 1];
    const int least = has_arrived ? static_cast<int>(!(from == to)) : kTickCost;
    has_arrived = has_arrived || to.cell == wish.goal;
    const int then = has_arrived ? 0 : candidates_.distance(wish, to);
    cost += std::max(least, left - then);
    left = then;
  }
  return cost + left;
}

int WindowSearch::least(int robot) const {
  const Wish& wish = wishes_[robot];
  const bool has_arrived = wish.goal == kNowhere || wish.goal == wish.state.cell;
  return has_arrived ? 0 : candidates_.distance(wish, wish.state);
}

/// All robots weigh nearly the same: rank only decides between equals.
int WindowSearch::weight(int robot) const {
  constexpr int kEach = 1000;
  return kEach + priorities_.weight(robot);
}

std::int64_t WindowSearch::weigh(int robot, int cost) const {
  return std::int64_t{weight(robot)} * cost;
}

void WindowSearch::improve(const std::function<bool()>& goes_on, std::mt19937_64& random) {
  improveEach();
  const int robots = static_cast<int>(wishes_.size());
  std::vector<int> delayed;
  for (int attempt = 0; goes_on(); ++attempt) {
    if (attempt % std::max(robots, 1) == 0) {
      delayed.clear();
      for (int robot = 0; robot < robots; ++robot) {
        if (paths_.path(robot).cost > least(robot)) delayed.push_back(robot);
      }
      if (delayed.empty()) return;
    }
    chooseGroup(delayed[random() % delayed.size()], random);
    replaceGroup();
  }
}

/// Improves each robot alone, among the paths of all others, by rank.
void WindowSearch::improveEach() {
  WindowPath path;
  for (const int robot : priorities_.order()) {
    const WindowPath old = paths_.path(robot);
    if (old.cost == least(robot)) continue;
    paths_.remove(robot);
    const bool is_found = route_.find(robot, wishes_[robot], old.cost, true, path);
    paths_.place(robot, is_found ? path : old);
  }
}

/// Chooses a robot, those in the way of its best path, and some nearby.
void WindowSearch::chooseGroup(int robot, std::mt19937_64& random) {
  for (const int robot : group_) is_chosen_[robot] = 0;
  group_.clear();
  add(robot);
  const int most = 2 + static_cast<int>(random() % (kMostGroup - 1));
  addBlockers(robot, most);
  addNear(robot, most, random);
  std::shuffle(group_.begin() + static_cast<int>(random() % 2), group_.end(), random);
}

void WindowSearch::add(int robot) {
  if (std::exchange(is_chosen_[robot], 1)) return;
  group_.push_back(robot);
}

void WindowSearch::addBlockers(int robot, int most) {
  WindowPath best;
  constexpr int kAny = std::numeric_limits<int>::max() / 2;
  if (!route_.find(robot, wishes_[robot], kAny, false, best)) return;
  for (int tick = 0; tick < paths_.ticks() && static_cast<int>(group_.size()) < most; ++tick) {
    const Cell from = best.states[tick].cell, to = best.states[tick + 1].cell;
    const int other = paths_.blocker(robot, from, to, tick);
    if (other != WindowPaths::kNobody) add(other);
  }
}

/// Adds robots met at random places around its path.
void WindowSearch::addNear(int robot, int most, std::mt19937_64& random) {
  constexpr int kTries = 12, kReach = 3;
  for (int i = 0; i < kTries && static_cast<int>(group_.size()) < most; ++i) {
    const int tick = static_cast<int>(random() % (paths_.ticks() + 1));
    const Cell cell = paths_.path(robot).states[tick].cell;
    const int x = floor_.x(cell) + static_cast<int>(random() % (2 * kReach + 1)) - kReach;
    const int y = floor_.y(cell) + static_cast<int>(random() % (2 * kReach + 1)) - kReach;
    if (x < 0 || y < 0 || x >= floor_.width() || y >= floor_.height()) continue;
    const int other = paths_.who(y * floor_.width() + x, tick);
    if (other != WindowPaths::kNobody) add(other);
  }
}

/// Gives the robots of the group other paths. Returns false, and restores their paths, if the new
/// ones cost more.
bool WindowSearch::replaceGroup() {
  std::int64_t room = 0;  // present cost of the group less its least cost
  kept_.clear();
  for (const int robot : group_) {
    kept_.push_back(paths_.path(robot));
    room += weigh(robot, kept_.back().cost - least(robot));
    paths_.remove(robot);
  }
  std::size_t placed = 0;
  for (; placed < group_.size() && room >= 0; ++placed) {
    const int robot = group_[placed];
    const std::int64_t most = std::min<std::int64_t>(room / weight(robot), 1 << 20);
    WindowPath path;
    const int bound = least(robot) + static_cast<int>(most);
    if (!route_.find(robot, wishes_[robot], bound, true, path)) break;
    room -= weigh(robot, path.cost - least(robot));
    paths_.place(robot, path);
  }
  if (placed == group_.size() && room >= 0) return true;
  for (std::size_t i = 0; i < placed; ++i) paths_.remove(group_[i]);
  for (std::size_t i = 0; i < group_.size(); ++i) paths_.place(group_[i], kept_[i]);
  return false;
}

}  // namespace fleet
