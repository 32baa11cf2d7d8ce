// SPDX-License-Identifier: Apache-2.0
#include "core/search/candidates.h"

#include <algorithm>
#include <cstdlib>

namespace fleet {
namespace {

/// Factor of path costs against edge costs: the fraction decides between equals, for the path that
/// moves early.
constexpr int kFine = 16;

}  // namespace

Candidates::Candidates(const Floor& floor, const Edges& edges, int depth, int horizon)
    : floor_(floor),
      edges_(edges),
      depth_(depth),
      horizon_(horizon),
      is_kept_(floor.size()),
      scratch_(1) {
  operations_.emplace_back();
  for (int free = 1; free <= depth; ++free) {
    operations_.push_back(std::make_unique<Operations>(free));
  }
}

void Candidates::begin(int robots) {
  paths_.resize(robots);
  is_known_.assign(robots, 0);
  for (const Cell cell : kept_) is_kept_[cell] = 0;
  kept_.clear();
}

void Candidates::keep(Cell cell) {
  is_kept_[cell] = 1;
  kept_.push_back(cell);
}

const std::vector<Path>& Candidates::of(int robot, const Wish& wish) {
  if (!is_known_[robot]) find(robot, wish, scratch_.front());
  return paths_[robot];
}

void Candidates::find(const std::vector<Wish>& wishes, const Threads& threads) {
  constexpr int kWorth = 100;        // robots that justify a thread
  if (threads.count() == 1) return;  // a single thread computes them on demand
  scratch_.resize(std::max<std::size_t>(threads.count(), scratch_.size()));
  threads.share(static_cast<int>(wishes.size()), kWorth, [&](int robot, int thread) {
    if (wishes[robot].goal == kNowhere) return;
    find(robot, wishes[robot], scratch_[thread]);
  });
}

void Candidates::find(int robot, const Wish& wish, Scratch& scratch) {
  std::vector<Path>& paths = paths_[robot];
  is_known_[robot] = 1;
  paths.clear();
  if (wish.stopped || wish.committed == horizon_) {
    paths.push_back(standing(wish));
    return;
  }
  grow(wish, scratch);
  scratch.order.clear();
  for (const Path& path : scratch.paths) {
    scratch.order.emplace_back(path.cost, static_cast<int>(scratch.order.size()));
  }
  std::sort(scratch.order.begin(), scratch.order.end());
  for (const auto& [cost, index] : scratch.order) paths.push_back(scratch.paths[index]);
}

Path Candidates::standing(const Wish& wish) const {
  Path path;
  const GridPose state = commit(wish, path);
  for (int tick = wish.committed; tick < horizon_; ++tick) {
    path.actions[tick] = Action::kWait;
    path.cells[tick + 1] = state.cell;
  }
  path.cost = cost(wish, path, state.heading);
  return path;
}

Path Candidates::along(const Wish& wish, const Actions& actions) const {
  Path path;
  GridPose state = wish.state;
  path.cells[0] = state.cell;
  for (int tick = 0; tick < horizon_; ++tick) {
    state = after(floor_, state, actions[tick]);
    path.actions[tick] = actions[tick];
    path.cells[tick + 1] = state.cell;
  }
  path.cost = cost(wish, path, state.heading);
  return path;
}

Path Candidates::rest(const Path& path, const GridPose& begin, const Wish& wish,
                      bool& is_punctual) const {
  Path rest;
  GridPose state = commit(wish, rest);
  // The poses of the path by tick. The rest begins where the path passes the robot's pose: at the
  // planned tick if the robot is punctual, else at the first one.
  std::array<GridPose, kMaxHorizon + 1> states{begin};
  for (int tick = 0; tick < horizon_; ++tick) {
    const int heading = turned(states[tick].heading, quarters(path.actions[tick]));
    states[tick + 1] = {path.cells[tick + 1], static_cast<Heading>(heading)};
  }
  const int due = std::min(wish.committed + 1, horizon_);
  int from = states[due] == state ? due : 0;
  while (from <= horizon_ && !(states[from] == state)) ++from;
  is_punctual = from == due;
  for (int tick = wish.committed; tick < horizon_; ++tick, ++from) {
    rest.actions[tick] = from < horizon_ ? path.actions[from] : Action::kWait;
    if (from < horizon_) state = states[from + 1];
    rest.cells[tick + 1] = state.cell;
  }
  rest.cost = cost(wish, rest, state.heading);
  return rest;
}

bool Candidates::canDrive(const Path& path, const Wish& wish) const {
  GridPose state = wish.state;
  for (int tick = 0; tick < horizon_; ++tick) {
    const Action action = path.actions[tick];
    if (wish.stopped ? action != Action::kWait
                     : tick < wish.committed && action != wish.commitment[tick]) {
      return false;
    }
    if (action == Action::kForward) {
      // Committed actions are always possible.
      if (tick >= wish.committed && next(wish, state.cell, state.heading) == kNowhere) return false;
      state.cell = path.cells[tick + 1];
    } else if (quarters(action) != 0 && tick >= wish.committed &&
               !edges_.mayTurn(wish.deck, state.cell)) {
      return false;
    }
    state.heading = turned(state.heading, quarters(action));
  }
  return true;
}

/// Writes the committed part of a path; returns the pose after it.
GridPose Candidates::commit(const Wish& wish, Path& path) const {
  GridPose state = wish.state;
  path.cells[0] = state.cell;
  for (int tick = 0; tick < wish.committed; ++tick) {
    const GridPose there = after(floor_, state, wish.commitment[tick]);
    if (there.cell != kNowhere) state = there;
    path.actions[tick] = wish.commitment[tick];
    path.cells[tick + 1] = state.cell;
  }
  return state;
}

Cell Candidates::next(const Wish& wish, Cell cell, int heading) const {
  const int edge = cell * kHeadings + heading;
  Cell to = edges_.next[static_cast<int>(wish.deck)][edge];
  if (to == kNowhere && wish.home != kNowhere && edges_.next[0][edge] == wish.home) to = wish.home;
  if (to == kNowhere ||
      (to != wish.goal && ((is_kept_[to] && !wish.enters_kept) || isDeadEnd(wish, to, heading)))) {
    return kNowhere;
  }
  return isPassingThrough(floor_, cell, to, wish.goal) ? kNowhere : to;
}

/// Returns whether a robot that comes there can neither drive straight on nor turn.
bool Candidates::isDeadEnd(const Wish& wish, Cell cell, int heading) const {
  return !edges_.mayTurn(wish.deck, cell) && next(wish, cell, heading) == kNowhere;
}

/// Returns whether a load has room where the actions after the committed ones turn.
bool Candidates::hasRoomToTurn(const Wish& wish, const Path& path, const Actions& actions) const {
  if (edges_.mayTurnEverywhere(wish.deck)) return true;
  for (int tick = wish.committed; tick < horizon_; ++tick) {
    const bool turns = quarters(actions[tick - wish.committed]) != 0;
    if (turns && !edges_.mayTurn(wish.deck, path.cells[tick])) return false;
  }
  return true;
}

void Candidates::grow(const Wish& wish, Scratch& scratch) const {
  std::vector<Cell>& reached = scratch.reached;
  scratch.paths.clear();
  Path path;
  const GridPose start = commit(wish, path);
  const int free = std::min(depth_, horizon_ - wish.committed);
  const int end = wish.committed + free;
  const Operations& operations = *operations_[free];
  reached.resize(operations.nodes().size());
  for (std::size_t i = 0; i < operations.nodes().size(); ++i) {
    const auto& node = operations.nodes()[i];
    const Cell from = node.parent < 0 ? start.cell : reached[node.parent];
    reached[i] = from;
    if (from == kNowhere || node.move == Operations::kStay) continue;
    reached[i] = next(wish, from, turned(start.heading, node.move));
  }
  for (const auto& leaf : operations.leaves()) {
    if (reached[leaf.node] == kNowhere) continue;
    for (int at = leaf.node, tick = end; at >= 0; at = operations.nodes()[at].parent, --tick) {
      path.cells[tick] = reached[at];
    }
    std::fill(path.cells.begin() + end + 1, path.cells.begin() + horizon_ + 1, path.cells[end]);
    int best = -1;
    for (int turn = 0; turn < kHeadings; ++turn) {
      if (!leaf.ends[turn] || !hasRoomToTurn(wish, path, leaf.actions[turn])) continue;
      const int cost = this->cost(wish, path, turned(start.heading, turn));
      if (best >= 0 && cost >= path.cost) continue;
      best = turn;
      path.cost = cost;
    }
    if (best < 0) continue;
    path.cost += leaf.late;
    std::copy_n(leaf.actions[best].begin(), free, path.actions.begin() + wish.committed);
    std::fill(path.actions.begin() + end, path.actions.begin() + horizon_, Action::kWait);
    scratch.paths.push_back(path);
  }
}

int Candidates::cost(const Wish& wish, const Path& path, int heading) const {
  const Cell end = path.cells[horizon_];
  if (wish.goal == kNowhere || wish.yields) {
    // A robot without a goal elsewhere prefers its cell, or an early return there.
    return kFine * kTickCost *
           (std::abs(floor_.x(end) - floor_.x(path.cells[0])) +
            std::abs(floor_.y(end) - floor_.y(path.cells[0])));
  }
  if (!wish.stops_at_goal || end == wish.goal) {
    for (int tick = 0; tick <= horizon_; ++tick) {
      if (path.cells[tick] != wish.goal) continue;
      return kFine * kTickCost * (tick - horizon_);
    }
  }
  return kFine * distance(wish, {end, static_cast<Heading>(heading)});
}

int Candidates::distance(const Wish& wish, GridPose state) const {
  if (wish.table != nullptr) return wish.table->at(state.cell, state.heading);
  return kTickCost * (std::abs(floor_.x(state.cell) - floor_.x(wish.goal)) +
                      std::abs(floor_.y(state.cell) - floor_.y(wish.goal)));
}

}  // namespace fleet
