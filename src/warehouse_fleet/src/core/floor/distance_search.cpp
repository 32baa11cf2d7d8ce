// SPDX-License-Identifier: Apache-2.0
#include "core/floor/distance_search.h"

#include <algorithm>

namespace fleet {
namespace {

constexpr int kQueues = 64;
static_assert(kMaxEdgeCost < kQueues && (kQueues & (kQueues - 1)) == 0);
static_assert(kMaxTurnTicks * kTickCost <= 0xf, "a quarter turn must fit into four bits");

/// Returns the costs of a cell's headings as a word: see DistanceTable.
inline std::uint32_t packed(const std::uint16_t* cost) {
  const std::uint32_t least = std::min(std::min(cost[0], cost[1]), std::min(cost[2], cost[3]));
  std::uint32_t word = least << 16;
  for (int heading = 0; heading < kHeadings; ++heading) {
    word |= std::min<std::uint32_t>(cost[heading] - least, 0xf) << (4 * heading);
  }
  return word;
}

}  // namespace

Window whole(const Floor& floor) { return {0, 0, floor.width(), floor.height()}; }

Window around(const Floor& floor, Cell cell, int reach) {
  const int left = std::max(0, floor.x(cell) - reach), top = std::max(0, floor.y(cell) - reach);
  const int right = std::min(floor.width(), floor.x(cell) + reach + 1);
  const int bottom = std::min(floor.height(), floor.y(cell) + reach + 1);
  return {left, top, right - left, bottom - top};
}

void Prices::update(const Edges& edges) {
  const std::vector<std::uint8_t>& costs = *edges.costs;
  for (int deck = 0; deck < 2; ++deck) {
    const std::vector<Cell>& next = edges.next[deck];
    of[deck].resize(next.size());
    for (std::size_t edge = 0; edge < next.size(); ++edge) {
      of[deck][edge] = next[edge] == kNowhere ? 0 : costs[edge];
    }
    for (const int edge : edges.against[deck]) {
      if (next[edge] != kNowhere)
        of[deck][edge] = kMaxEdgeCost;  // last resort: other ways are better
    }
  }
}

DistanceSearch::DistanceSearch(const Floor& floor, const Edges& edges, const Prices& prices,
                               int turn_ticks)
    : floor_(floor),
      edges_(edges),
      prices_(prices),
      turn_cost_(turn_ticks * kTickCost),
      step_{1, floor.width(), -1, -floor.width()},
      cost_(floor.size() * kHeadings),
      queues_(kQueues) {
  for (Cell cell = 0; cell < floor.size() && !has_lanes_; ++cell) has_lanes_ = floor.isLane(cell);
}

void DistanceSearch::run(Deck deck, Cell goal, const Window& window, bool is_entered) {
  deck_ = deck;
  goal_ = goal;
  price_ = prices_.of[static_cast<int>(deck)].data();
  turns_everywhere_ = edges_.mayTurnEverywhere(deck);
  // A goal may be a storage place, to which the aisles' deck has no edge.
  into_goal_ = is_entered ? floor_.edges(deck).data() : edges_.next[0].data();
  open(window);
  for (int heading = 0; heading < kHeadings; ++heading) push(goal * kHeadings + heading, 0);
  // The queues hold all costs from the present one to the highest edge cost above it.
  for (int cost = 0, idle = 0; idle < kQueues; ++cost, ++idle) {
    auto& queue = queues_[cost & (kQueues - 1)];
    for (std::size_t i = 0; i < queue.size(); ++i) {
      if (cost_[queue[i]] == cost) relax(queue[i], cost);
      idle = 0;
    }
    queue.clear();
  }
}

/// Closes the previous window and opens this one.
void DistanceSearch::open(const Window& window) {
  const auto fill = [this](const Window& which, std::uint16_t cost) {
    for (int row = which.top; row < which.top + which.rows; ++row) {
      const auto begin = cost_.begin() + (row * floor_.width() + which.left) * kHeadings;
      std::fill(begin, begin + which.columns * kHeadings, cost);
    }
  };
  fill(window_, 0);
  fill(window, kUnreachable);
  window_ = window;
}

inline void DistanceSearch::push(int state, int cost) {
  if (cost >= cost_[state]) return;
  cost_[state] = static_cast<std::uint16_t>(cost);
  queues_[cost & (kQueues - 1)].push_back(state);
}

/// Updates the cost of the states from which one action leads to this one.
inline void DistanceSearch::relax(int state, int cost) {
  const Cell cell = state / kHeadings;
  const int heading = state % kHeadings;
  if (turns_everywhere_ || edges_.mayTurn(deck_, cell)) {
    push(cell * kHeadings + turned(heading, 1), cost + turn_cost_);
    push(cell * kHeadings + turned(heading, -1), cost + turn_cost_);
  }
  enter(cell, heading, cost);
}

inline void DistanceSearch::enter(Cell cell, int heading, int cost) {
  // Beyond the left or right edge this is a cell of another row, whose edges don't lead here.
  const Cell from = cell - step_[heading];
  if (from < 0 || from >= floor_.size()) return;
  const int edge = from * kHeadings + heading;
  int price = this->price(cell, edge);
  if (price == 0) return;
  if (has_lanes_ && floor_.isLane(cell) && !floor_.isLane(from)) {
    if (!floor_.isLane(goal_)) return;
    price = kMaxEdgeCost;  // lanes of other stations are no short cuts
  }
  push(edge, cost + price);
}

/// Returns the cost of the edge into a cell; 0 if it is closed.
inline int DistanceSearch::price(Cell cell, int edge) const {
  if (cell != goal_) return price_[edge];
  return into_goal_[edge] == cell ? (*edges_.costs)[edge] : 0;
}

void DistanceSearch::pack(std::vector<std::uint32_t>& words) const {
  words.resize(window_.size());
  auto word = words.begin();
  for (int row = window_.top; row < window_.top + window_.rows; ++row) {
    const std::uint16_t* cost = &cost_[(row * floor_.width() + window_.left) * kHeadings];
    for (int column = 0; column < window_.columns; ++column, cost += kHeadings) {
      *word++ = packed(cost);
    }
  }
}

void DistanceSearch::pack(const std::vector<Cell>& cells, std::vector<std::uint32_t>& words) const {
  words.resize(cells.size() + 1);
  auto word = words.begin();
  *word++ = static_cast<std::uint32_t>(kUnreachable) << 16;
  for (const Cell cell : cells) *word++ = packed(&cost_[cell * kHeadings]);
}

}  // namespace fleet
