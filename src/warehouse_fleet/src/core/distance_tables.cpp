// SPDX-License-Identifier: Apache-2.0
#include "distance_tables.h"

#include <algorithm>
#include <iterator>
#include <tuple>
#include <utility>

namespace fleet {
namespace {

constexpr int kQueues = 64;
static_assert(kMaxEdgeCost < kQueues && (kQueues & (kQueues - 1)) == 0);
static_assert(kMaxTurnTicks * kTickCost <= 0xf, "a quarter turn must fit into four bits");

}  // namespace

DistanceTables::DistanceTables(const Floor& floor, const Edges& edges, int turn_ticks,
                               std::size_t bytes)
    : floor_(floor),
      edges_(edges),
      turn_cost_(turn_ticks * kTickCost),
      capacity_(std::max<std::size_t>(1, bytes / tableBytes())),
      cost_(floor.size() * kHeadings),
      queues_(kQueues) {}

void DistanceTables::begin(int now, int version, int builds) {
  now_ = now;
  version_ = version;
  builds_ = builds;
  asked_.clear();
}

const DistanceTable* DistanceTables::find(Deck deck, Cell goal, bool is_urgent) {
  const std::int64_t key = std::int64_t{goal} << 1 | static_cast<int>(deck);
  if (const auto known = index_.find(key); known != index_.end()) {
    tables_.splice(tables_.begin(), tables_, known->second);
    ask(tables_.front(), is_urgent);
    return &tables_.front().table;
  }
  if (builds_ == 0) return nullptr;
  if (tables_.size() < capacity_) {
    tables_.emplace_front();
  } else {
    index_.erase(tables_.back().key);
    tables_.splice(tables_.begin(), tables_, std::prev(tables_.end()));
  }
  tables_.front().key = key;
  index_[key] = tables_.begin();
  --builds_;
  build(tables_.front());
  ask(tables_.front(), is_urgent);
  return &tables_.front().table;
}

void DistanceTables::ask(Entry& entry, bool is_urgent) {
  const bool is_first = std::exchange(entry.asked, now_) != now_;
  if (is_first) asked_.push_back(&entry);
  entry.is_urgent = is_urgent || (!is_first && entry.is_urgent);
}

void DistanceTables::renew(int max_age, int builds) {
  const auto is_young = [&](const Entry* entry) {
    return entry->table.version_ == version_ && now_ - entry->table.made_ < max_age;
  };
  asked_.erase(std::remove_if(asked_.begin(), asked_.end(), is_young), asked_.end());
  const auto turn = [](const Entry* entry) {
    return std::make_tuple(!entry->is_urgent, entry->table.made_, entry->key);
  };
  const auto end = asked_.begin() + std::min<std::size_t>(asked_.size(), builds);
  std::partial_sort(asked_.begin(), end, asked_.end(),
                    [&](const Entry* one, const Entry* other) { return turn(one) < turn(other); });
  std::for_each(asked_.begin(), end, [this](Entry* entry) { build(*entry); });
}

void DistanceTables::build(Entry& entry) {
  const Deck deck = static_cast<Deck>(entry.key & 1);
  const Cell goal = static_cast<Cell>(entry.key >> 1);
  std::fill(cost_.begin(), cost_.end(), kUnreachable);
  for (int heading = 0; heading < kHeadings; ++heading) push(goal * kHeadings + heading, 0);
  // The queues hold all costs from the present one to the dearest edge away.
  for (int cost = 0, idle = 0; idle < kQueues; ++cost, ++idle) {
    auto& queue = queues_[cost & (kQueues - 1)];
    for (std::size_t i = 0; i < queue.size(); ++i) {
      if (cost_[queue[i]] == cost) relax(deck, goal, queue[i]);
      idle = 0;
    }
    queue.clear();
  }
  pack(entry.table);
  entry.table.version_ = version_;
  entry.table.made_ = now_;
}

void DistanceTables::push(int state, int cost) {
  if (cost >= cost_[state]) return;
  cost_[state] = static_cast<std::uint16_t>(cost);
  queues_[cost & (kQueues - 1)].push_back(state);
}

/// To the states from which one action leads to this one.
void DistanceTables::relax(Deck deck, Cell goal, int state) {
  const int cost = cost_[state];
  const Cell cell = state / kHeadings;
  const int heading = state % kHeadings;
  if (edges_.mayTurn(deck, cell)) {
    push(cell * kHeadings + turned(heading, 1), cost + turn_cost_);
    push(cell * kHeadings + turned(heading, -1), cost + turn_cost_);
  }
  const Cell from = floor_.beside(cell, heading + 2);
  if (from == kNowhere) return;
  // A goal may be a storage place, which the aisles' deck does not lead into.
  const auto& next = edges_.next[cell == goal ? 0 : static_cast<int>(deck)];
  const int edge = from * kHeadings + heading;
  if (next[edge] != cell || isPassingThrough(floor_, from, cell, goal)) return;
  // Nor for a short cut to another station's lane.
  const bool enters = floor_.isLane(cell) && !floor_.isLane(from);
  push(edge, cost + (enters ? kMaxEdgeCost : (*edges_.costs)[edge]));
}

void DistanceTables::pack(DistanceTable& table) const {
  table.words_.resize(floor_.size());
  for (Cell cell = 0; cell < floor_.size(); ++cell) {
    const std::uint16_t* cost = &cost_[cell * kHeadings];
    const std::uint32_t least = std::min(std::min(cost[0], cost[1]), std::min(cost[2], cost[3]));
    std::uint32_t word = least << 16;
    for (int heading = 0; heading < kHeadings; ++heading) {
      word |= std::min<std::uint32_t>(cost[heading] - least, 0xf) << (4 * heading);
    }
    table.words_[cell] = word;
  }
}

}  // namespace fleet
