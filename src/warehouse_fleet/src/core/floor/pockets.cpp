// SPDX-License-Identifier: Apache-2.0
#include "core/floor/pockets.h"

#include <algorithm>

namespace fleet {
namespace {

/// A depth-first search of one connected part.
class DepthFirst {
 public:
  explicit DepthFirst(const Floor& floor)
      : floor_(floor), number_(floor.size(), -1), lowest_(floor.size()), size_(floor.size()) {}

  void run(Cell root) {
    order_.clear();
    visit(root);
    while (!way_.empty()) {
      Visit& step = way_.back();
      if (step.next == step.beside.size()) {
        leave();
        continue;
      }
      const Cell next = step.beside[step.next++];
      if (number_[next] < 0) {
        visit(next);
      } else {
        lowest_[step.cell] = std::min(lowest_[step.cell], number_[next]);
      }
    }
  }

  /// Clears the last part that was searched.
  void forget() {
    for (const Cell cell : order_) number_[cell] = -1;
    cut_.clear();
  }

  bool knows(Cell cell) const { return number_[cell] >= 0; }
  /// Returns cells in the order of the search: each subtree is contiguous.
  const std::vector<Cell>& order() const { return order_; }
  /// Returns cells whose subtree only the cell before them connects to the rest.
  const std::vector<Cell>& cut() const { return cut_; }
  int number(Cell cell) const { return number_[cell]; }
  /// Returns the number of cells in the cell's subtree.
  int size(Cell cell) const { return size_[cell]; }

 private:
  struct Visit {
    Cell cell;
    std::vector<Cell> beside;
    std::size_t next = 0;
  };

  void visit(Cell cell) {
    number_[cell] = lowest_[cell] = static_cast<int>(order_.size());
    size_[cell] = 1;
    order_.push_back(cell);
    way_.push_back({cell, neighbours(floor_, cell)});
  }

  void leave() {
    const Cell cell = way_.back().cell;
    way_.pop_back();
    if (way_.empty()) return;
    const Cell before = way_.back().cell;
    size_[before] += size_[cell];
    lowest_[before] = std::min(lowest_[before], lowest_[cell]);
    if (lowest_[cell] >= number_[before]) cut_.push_back(cell);
  }

  const Floor& floor_;
  std::vector<int> number_, lowest_, size_;
  std::vector<Cell> order_, cut_;
  std::vector<Visit> way_;
};

/// Returns a cell in the middle of the search tree: it is in no pocket of less than half of the
/// cells.
Cell middle(const DepthFirst& search) {
  const int half = static_cast<int>(search.order().size() + 1) / 2;
  Cell best = search.order().front();
  for (const Cell cell : search.order()) {
    if (search.size(cell) >= half && search.size(cell) <= search.size(best)) best = cell;
  }
  return best;
}

}  // namespace

std::vector<Cell> neighbours(const Floor& floor, Cell cell) {
  std::vector<Cell> cells;
  for (int heading = 0; heading < kHeadings; ++heading) {
    const Cell next = floor.next(Deck::kUnder, cell, heading);
    if (next != kNowhere) cells.push_back(next);
  }
  return cells;
}

std::vector<std::uint8_t> pockets(const Floor& floor, int most) {
  std::vector<std::uint8_t> is_pocket(floor.size());
  DepthFirst search(floor);
  for (Cell cell = 0; cell < floor.size(); ++cell) {
    if (!floor.isPassable(cell) || search.knows(cell)) continue;
    search.run(cell);
    const Cell root = middle(search);
    search.forget();
    search.run(root);
    const int limit = std::min<int>(most, static_cast<int>(search.order().size()) / 3);
    for (const Cell end : search.cut()) {
      if (search.size(end) > limit) continue;
      const auto begin = search.order().begin() + search.number(end);
      std::for_each(begin, begin + search.size(end), [&](Cell inner) { is_pocket[inner] = 1; });
    }
  }
  return is_pocket;
}

}  // namespace fleet
