// SPDX-License-Identifier: Apache-2.0
#include "core/search/operations.h"

#include <algorithm>

namespace fleet {

namespace {

std::ptrdiff_t turns(const Actions& actions) {
  return std::count_if(actions.begin(), actions.end(), [](Action a) { return quarters(a) != 0; });
}

}  // namespace

Operations::Operations(int depth) : depth_(depth) {
  Actions actions{};
  grow(-1, 0, 0, actions);
}

/// Extends the tree. Of equal operations, the one with the fewest turns stays, then the one that is
/// tried first: it turns early, and is ready when the way becomes free.
void Operations::grow(int parent, int tick, int heading, Actions& actions) {
  if (tick == depth_) return end(parent, heading, actions);
  for (const Action action :
       {Action::kForward, Action::kTurnPositive, Action::kTurnNegative, Action::kWait}) {
    actions[tick] = action;
    const int move = action == Action::kForward ? heading : kStay;
    grow(child(parent, move, tick), tick + 1, turned(heading, quarters(action)), actions);
  }
}

void Operations::end(int node, int heading, const Actions& actions) {
  if (nodes_[node].leaf < 0) {
    nodes_[node].leaf = static_cast<std::int16_t>(leaves_.size());
    leaves_.emplace_back();
    leaves_.back().node = static_cast<std::int16_t>(node);
    for (int at = node; at >= 0; at = nodes_[at].parent) {
      if (nodes_[at].move != kStay) leaves_.back().late += nodes_[at].tick;
    }
  }
  Leaf& leaf = leaves_[nodes_[node].leaf];
  if (leaf.ends[heading] && turns(leaf.actions[heading]) <= turns(actions)) return;
  leaf.ends[heading] = true;
  leaf.actions[heading] = actions;
}

int Operations::child(int parent, int move, int tick) {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (nodes_[i].parent == parent && nodes_[i].move == move && nodes_[i].tick == tick) {
      return static_cast<int>(i);
    }
  }
  nodes_.push_back({static_cast<std::int16_t>(parent), static_cast<std::uint8_t>(move),
                    static_cast<std::uint8_t>(tick), -1});
  return static_cast<int>(nodes_.size()) - 1;
}

}  // namespace fleet
