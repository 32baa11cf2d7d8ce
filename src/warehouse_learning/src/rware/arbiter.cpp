// SPDX-License-Identifier: Apache-2.0
#include "rware/arbiter.h"

#include <algorithm>

#include "rware/python_set.h"

namespace rware {
namespace {

/// The graph of wishes as networkx.DiGraph builds it: nodes and edges in the order in which robots
/// add them.
struct Graph {
  Graph(const std::vector<MoveWish>& wishes, int cells) : next(cells, -1), before(cells) {
    std::vector<char> known(cells);
    for (const MoveWish& wish : wishes) {
      for (const int cell : {wish.from, wish.to}) {
        if (!known[cell]) nodes.push_back(cell);
        known[cell] = true;
      }
      next[wish.from] = wish.to;
      before[wish.to].push_back(wish.from);
    }
  }
  std::vector<int> nodes, next;
  std::vector<std::vector<int>> before;
};

/// Returns the connected part of a cell, in the order in which networkx's breadth-first search adds
/// its cells to a set.
PythonSet partWith(int cell, const Graph& graph, const Layout& layout) {
  PythonSet part;
  std::vector<int> reached{cell};
  const auto reach = [&](int other) {
    if (part.contains(other, layout.hashes[other])) return;
    part.add(other, layout.hashes[other]);
    reached.push_back(other);
  };
  part.add(cell, layout.hashes[cell]);
  for (std::size_t i = 0; i < reached.size(); ++i) {
    const int at = reached[i];
    if (graph.next[at] >= 0) reach(graph.next[at]);
    for (const int other : graph.before[at]) reach(other);
  }
  return part;
}

/// Returns the first cell of the part, by the order of the graph's nodes.
int firstOf(const PythonSet& part, const Graph& graph, const Layout& layout) {
  return *std::find_if(graph.nodes.begin(), graph.nodes.end(),
                       [&](int cell) { return part.contains(cell, layout.hashes[cell]); });
}

}  // namespace

const std::vector<char>& Arbiter::settle(const std::vector<MoveWish>& wishes,
                                         const std::vector<int>& robot_at) {
  wishes_ = &wishes;
  committed_.assign(wishes.size(), false);
  link(robot_at);
  commitRings();
  measureChains();
  commitChains();
  return committed_;
}

void Arbiter::link(const std::vector<int>& robot_at) {
  const std::size_t count = wishes_->size();
  ahead_.resize(count);
  behind_.resize(count);
  for (auto& robots : behind_) robots.clear();
  for (std::size_t robot = 0; robot < count; ++robot) {
    const MoveWish& wish = (*wishes_)[robot];
    ahead_[robot] = wish.to == wish.from ? static_cast<int>(robot) : robot_at[wish.to];
    if (wish.to != wish.from && ahead_[robot] >= 0) {
      behind_[ahead_[robot]].push_back(static_cast<int>(robot));
    }
  }
}

void Arbiter::commitRings() {
  // Every robot has at most one robot ahead, so that a walk ends or runs into a ring.
  visited_.assign(ahead_.size(), 0);
  enum : char { kUnseen, kOnWalk, kDone };
  std::vector<int> walk;
  for (int start = 0; start < static_cast<int>(ahead_.size()); ++start) {
    walk.clear();
    int robot = start;
    for (; robot >= 0 && visited_[robot] == kUnseen; robot = ahead_[robot]) {
      visited_[robot] = kOnWalk;
      walk.push_back(robot);
    }
    if (robot >= 0 && visited_[robot] == kOnWalk) {
      const auto ring = std::find(walk.begin(), walk.end(), robot);
      if (walk.end() - ring != 2) {
        std::for_each(ring, walk.end(), [this](int member) { committed_[member] = true; });
      }
    }
    for (const int member : walk) visited_[member] = kDone;
  }
}

void Arbiter::measureChains() {
  length_.assign(ahead_.size(), 0);
  std::vector<int> open;  // robots behind which all chains are measured
  std::vector<int> missing(ahead_.size());
  for (std::size_t robot = 0; robot < ahead_.size(); ++robot) {
    missing[robot] = static_cast<int>(behind_[robot].size());
    if (!missing[robot]) open.push_back(static_cast<int>(robot));
  }
  while (!open.empty()) {
    const int robot = open.back();
    open.pop_back();
    int longest = 0;
    for (const int other : behind_[robot]) longest = std::max(longest, length_[other]);
    length_[robot] = longest + 1;
    const int ahead = ahead_[robot];
    if (ahead >= 0 && ahead != robot && --missing[ahead] == 0) open.push_back(ahead);
  }
}

void Arbiter::commitChains() {
  visited_.assign(ahead_.size(), false);
  std::vector<int> rivals;
  for (std::size_t robot = 0; robot < ahead_.size(); ++robot) {
    if (ahead_[robot] >= 0 || visited_[robot]) continue;
    rivals.clear();
    for (std::size_t other = robot; other < ahead_.size(); ++other) {
      if (ahead_[other] >= 0 || (*wishes_)[other].to != (*wishes_)[robot].to) continue;
      visited_[other] = true;
      rivals.push_back(static_cast<int>(other));
    }
    commitChain(longest(rivals));
  }
}

void Arbiter::commitChain(int head) {
  for (int robot = head; robot >= 0; robot = longest(behind_[robot])) committed_[robot] = true;
}

/// Returns the robot with the longest chain behind it; of several, the first in the order of the
/// graph.
int Arbiter::longest(const std::vector<int>& robots) {
  int most = 0, count = 0, best = -1;
  for (const int robot : robots) {
    if (length_[robot] > most) most = length_[robot], count = 0, best = robot;
    count += length_[robot] == most;
  }
  if (count < 2) return best;
  const std::vector<int> order = orderAround(best);
  const auto place = [&](int robot) {
    return std::find(order.begin(), order.end(), (*wishes_)[robot].from);
  };
  for (const int robot : robots) {
    if (length_[robot] == most && place(robot) < place(best)) best = robot;
  }
  return best;
}

/// Returns the cells around a robot in the order in which networkx iterates over a copy of that
/// part of the graph: the set's order if the part is small, else the graph's.
std::vector<int> Arbiter::orderAround(int robot) const {
  const Graph graph(*wishes_, layout_.size());
  PythonSet part = partWith((*wishes_)[robot].from, graph, layout_);
  part = partWith(firstOf(part, graph, layout_), graph, layout_);
  if (2 * part.size() >= graph.nodes.size()) return graph.nodes;
  PythonSet copy;
  part.forEach([&](int cell, std::uint64_t hash) { copy.add(cell, hash); });
  std::vector<int> order;
  copy.forEach([&](int cell, std::uint64_t) { order.push_back(cell); });
  return order;
}

}  // namespace rware
