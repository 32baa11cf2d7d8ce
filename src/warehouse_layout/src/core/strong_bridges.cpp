// SPDX-License-Identifier: Apache-2.0
#include "warehouse_layout/strong_bridges.h"

#include <algorithm>
#include <utility>

namespace layout {
namespace {

/// Returns all nodes in the order in which a depth-first search leaves them.
std::vector<Cell> postorder(const Neighbours& ahead) {
  std::vector<Cell> order;
  std::vector<std::uint8_t> visited(ahead.size(), 0);
  std::vector<std::pair<Cell, int>> stack;
  for (Cell root = 0; root < static_cast<Cell>(ahead.size()); ++root) {
    if (visited[root]) continue;
    visited[root] = 1;
    stack.emplace_back(root, 0);
    while (!stack.empty()) {
      const auto [node, heading] = stack.back();
      if (heading == kHeadings) {
        order.push_back(node);
        stack.pop_back();
        continue;
      }
      ++stack.back().second;
      const Cell to = ahead[node][heading];
      if (to == kNowhere || visited[to]) continue;
      visited[to] = 1;
      stack.emplace_back(to, 0);
    }
  }
  return order;
}

/// Dominators by the semi-NCA algorithm (Georgiadis, 2005), of all parts at once, each from its
/// first node. Nodes are numbered in the order of a depth-first search.
class Dominators {
 public:
  Dominators(const Neighbours& ahead, const Neighbours& back, const std::vector<int>& part)
      : ahead_(ahead), back_(back), part_(part), number_(ahead.size(), -1) {
    for (Cell root = 0; root < static_cast<Cell>(ahead.size()); ++root) {
      if (number_[root] < 0) search(root);
    }
    findSemidominators();
    for (int i = 0; i < count(); ++i) {
      while (dominator_[i] > semi_[i]) dominator_[i] = dominator_[dominator_[i]];
    }
    spanSubtrees();
  }

  /// Returns for each node the one whose edge to it is on all ways there; kNowhere if there is
  /// none.
  std::vector<Cell> onlyWaysIn() const {
    std::vector<Cell> out(number_.size(), kNowhere);
    for (int i = 0; i < count(); ++i) {
      if (dominator_[i] >= 0 && isOnlyEntry(i)) out[node_[i]] = node_[dominator_[i]];
    }
    return out;
  }

 private:
  int count() const { return static_cast<int>(node_.size()); }

  void search(Cell root) {
    std::vector<std::pair<Cell, int>> stack = {{root, -1}};
    while (!stack.empty()) {
      const auto [node, parent] = stack.back();
      stack.pop_back();
      if (number_[node] >= 0) continue;
      number_[node] = count();
      node_.push_back(node);
      dominator_.push_back(parent);
      for (const Cell to : ahead_[node]) {
        if (isWithin(to, node) && number_[to] < 0) stack.emplace_back(to, number_[node]);
      }
    }
  }

  bool isWithin(Cell node, Cell other) const {
    return node != kNowhere && part_[node] == part_[other];
  }

  void findSemidominators() {
    ancestor_ = dominator_;
    semi_.resize(count());
    for (int i = 0; i < count(); ++i) semi_[i] = i;
    best_ = semi_;
    for (int i = count() - 1; i >= 0; --i) {
      if (dominator_[i] < 0) continue;
      semi_[i] = dominator_[i];
      for (const Cell from : back_[node_[i]]) {
        if (!isWithin(from, node_[i])) continue;
        semi_[i] = std::min(semi_[i], semi_[bestAbove(number_[from], i + 1)]);
      }
    }
  }

  /// Returns the node with the least semidominator among `i` and its ancestors from `linked` on,
  /// and compresses the path for later calls.
  int bestAbove(int i, int linked) {
    path_.clear();
    for (; ancestor_[i] >= linked; i = ancestor_[i]) path_.push_back(i);
    for (; !path_.empty(); path_.pop_back()) {
      const int below = path_.back();
      if (semi_[best_[i]] < semi_[best_[below]]) best_[below] = best_[i];
      ancestor_[below] = ancestor_[i];
      i = below;
    }
    return best_[i];
  }

  /// Numbers the tree of dominators, so that the descendants of each node are contiguous.
  void spanSubtrees() {
    below_.assign(count(), 1);
    for (int i = count() - 1; i >= 0; --i) {
      if (dominator_[i] >= 0) below_[dominator_[i]] += below_[i];
    }
    begin_.assign(count(), 0);
    std::vector<int> next(count());
    int roots = 0;
    for (int i = 0; i < count(); ++i) {
      int& slot = dominator_[i] < 0 ? roots : next[dominator_[i]];
      begin_[i] = slot;
      slot += below_[i];
      next[i] = begin_[i] + 1;
    }
  }

  bool dominates(int i, int other) const {
    return begin_[i] <= begin_[other] && begin_[other] < begin_[i] + below_[i];
  }

  /// Returns whether all edges to `i`, except that from its dominator, come from nodes that `i`
  /// dominates.
  bool isOnlyEntry(int i) const {
    bool is_edge = false;
    for (const Cell from : back_[node_[i]]) {
      if (!isWithin(from, node_[i])) continue;
      const int number = number_[from];
      if (number == dominator_[i]) {
        is_edge = true;
      } else if (!dominates(i, number)) {
        return false;
      }
    }
    return is_edge;
  }

  const Neighbours &ahead_, &back_;
  const std::vector<int>& part_;
  std::vector<int> number_;  // number of each node
  std::vector<Cell> node_;   // node of each number; the following also go by number
  std::vector<int> dominator_, semi_, ancestor_, best_, below_, begin_, path_;
};

}  // namespace

std::vector<int> strongParts(const Neighbours& ahead, const Neighbours& back) {
  std::vector<int> part(ahead.size(), -1);
  const std::vector<Cell> order = postorder(ahead);
  int parts = 0;
  for (auto root = order.rbegin(); root != order.rend(); ++root) {
    if (part[*root] >= 0) continue;
    std::vector<Cell> queue = {*root};
    part[*root] = parts;
    for (std::size_t i = 0; i < queue.size(); ++i) {
      for (const Cell from : back[queue[i]]) {
        if (from == kNowhere || part[from] >= 0) continue;
        part[from] = parts;
        queue.push_back(from);
      }
    }
    ++parts;
  }
  return part;
}

StrongBridges::StrongBridges(const Neighbours& ahead, const Neighbours& back,
                             const std::vector<int>& part)
    : only_way_in_(Dominators(ahead, back, part).onlyWaysIn()),
      only_way_out_(Dominators(back, ahead, part).onlyWaysIn()) {}

}  // namespace layout
