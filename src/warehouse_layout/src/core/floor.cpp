// SPDX-License-Identifier: Apache-2.0
#include "warehouse_layout/floor.h"

#include <cstdlib>
#include <limits>
#include <utility>
#include <vector>

namespace layout {
namespace {

std::vector<std::uint8_t> filled(const std::vector<std::uint8_t>& values, Cell size,
                                 std::uint8_t otherwise, const char* name) {
  if (values.empty()) return std::vector<std::uint8_t>(size, otherwise);
  if (static_cast<Cell>(values.size()) != size) {
    throw FloorError(std::string(name) + " has " + std::to_string(values.size()) +
                     " elements; width * height = " + std::to_string(size) + " were expected");
  }
  return values;
}

Cell checkedSize(const FloorDescription& description) {
  constexpr std::int64_t kLargest = std::numeric_limits<Cell>::max() / 16;
  const std::int64_t size = std::int64_t{description.width} * description.height;
  if (description.width < 1 || description.height < 1 || size > kLargest) {
    throw FloorError("a floor of " + std::to_string(description.width) + " x " +
                     std::to_string(description.height) + " cells; at least 1 x 1 and at most " +
                     std::to_string(kLargest) + " cells were expected");
  }
  return static_cast<Cell>(size);
}

}  // namespace

Floor::Floor(const FloorDescription& description)
    : width_(description.width), height_(description.height) {
  const Cell cells = checkedSize(description);
  passable_ = filled(description.passable, cells, 1, "passable");
  storage_ = filled(description.storage, cells, 0, "storage");
  parking_ = filled(description.parking, cells, 0, "parking");
  for (Cell cell = 0; cell < cells; ++cell) storage_[cell] |= parking_[cell];
  lane_ = filled(description.lane, cells, 0, "lane");
  const auto exits = filled(description.exits, cells, 0xf, "exits");
  for (auto& edges : next_) edges.assign(cells * kHeadings, kNowhere);
  for (Cell cell = 0; cell < cells; ++cell) {
    if (!passable_[cell]) continue;
    for (int heading = 0; heading < kHeadings; ++heading) {
      const Cell to = beside(cell, heading);
      if (to == kNowhere || !passable_[to] || !(exits[cell] >> heading & 1)) continue;
      next_[0][cell * kHeadings + heading] = to;
      if (!storage_[to]) next_[1][cell * kHeadings + heading] = to;
    }
  }
}

Cell Floor::beside(Cell cell, int heading) const {
  switch (heading & 3) {
    case 0:
      return x(cell) + 1 < width_ ? cell + 1 : kNowhere;
    case 1:
      return y(cell) + 1 < height_ ? cell + width_ : kNowhere;
    case 2:
      return x(cell) > 0 ? cell - 1 : kNowhere;
    default:
      return y(cell) > 0 ? cell - width_ : kNowhere;
  }
}

namespace {

/// Distances of cells from the start of a search. Entries of earlier searches are ignored, so that
/// a search over a few cells of a large floor takes as long as these few.
class Distances {
 public:
  void begin(std::size_t cells) {
    if (search_.size() < cells || ++now_ == 0) {
      search_.assign(cells, 0);
      steps_.resize(cells);
      now_ = 1;
    }
  }
  int of(Cell cell) const { return search_[cell] == now_ ? steps_[cell] : -1; }
  void set(Cell cell, int steps) {
    search_[cell] = now_;
    steps_[cell] = steps;
  }

 private:
  std::vector<std::uint32_t> search_;  ///< the last search that reached each cell
  std::vector<int> steps_;
  std::uint32_t now_ = 0;
};

int alongAxes(const Floor& floor, Cell a, Cell b) {
  return std::abs(floor.x(a) - floor.x(b)) + std::abs(floor.y(a) - floor.y(b));
}

struct Step {
  Cell cell;
  int steps;
};

}  // namespace

// Searches by A*. A step brings a robot one cell nearer along the axes, or takes it one away, so
// that the queue has only two costs: the least sum of steps done and steps left, and two more.
int shortest(const Floor& floor, Deck deck, Cell from, Cell to) {
  thread_local Distances distances;
  distances.begin(floor.size());
  distances.set(from, 0);
  std::vector<Step> now{{from, 0}}, later;
  for (; !now.empty(); std::swap(now, later)) {
    while (!now.empty()) {
      const auto [cell, steps] = now.back();
      now.pop_back();
      if (steps > distances.of(cell)) continue;
      if (cell == to) return steps;
      const int left = alongAxes(floor, cell, to);
      for (int heading = 0; heading < kHeadings; ++heading) {
        const Cell over = floor.next(Deck::kUnder, cell, heading);
        const Cell next = over == to ? to : floor.next(deck, cell, heading);
        if (next == kNowhere) continue;
        if (const int known = distances.of(next); known >= 0 && known <= steps + 1) continue;
        if (isPassingThrough(floor, cell, next, to)) continue;
        distances.set(next, steps + 1);
        (alongAxes(floor, next, to) < left ? now : later).push_back({next, steps + 1});
      }
    }
  }
  return -1;
}

std::string Floor::name(Cell cell) const {
  if (!has(cell)) return "cell " + std::to_string(cell) + " (off the floor)";
  return "(" + std::to_string(x(cell)) + ", " + std::to_string(y(cell)) + ")";
}

}  // namespace layout
