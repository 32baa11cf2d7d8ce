// SPDX-License-Identifier: Apache-2.0
#include "core/floor/closures.h"

#include <algorithm>
#include <utility>

namespace fleet {
namespace {

constexpr int kLasting = 15;  // ticks; robots wait for shorter closures

void sort(std::vector<Cell>& cells) {
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
}

/// Returns the cells of the same lane that lead to one: the previous cell, and those with a short
/// cut.
std::vector<Cell> before(const Floor& floor, Cell cell) {
  std::vector<Cell> cells;
  if (!floor.isLane(cell)) return cells;
  for (int heading = 0; heading < kHeadings; ++heading) {
    const Cell from = floor.beside(cell, heading + 2);
    if (from == kNowhere || !floor.isLane(from)) continue;
    if (floor.next(Deck::kUnder, from, heading) == cell) cells.push_back(from);
  }
  return cells;
}

}  // namespace

Closures::Closures(const Floor& floor, const std::vector<std::uint8_t>& costs) : floor_(floor) {
  edges_.next[0] = floor.edges(Deck::kUnder);
  edges_.next[1] = floor.edges(Deck::kAisles);
  edges_.costs = &costs;
}

void Closures::update(const Fleet& fleet) {
  Closed closed = now(fleet);
  Closed lasting = this->lasting(closed);
  ++tick_;
  if (!(closed == closed_) || !(lasting == lasting_)) {
    open();
    closed_ = std::move(closed);
    lasting_ = std::move(lasting);
    close();
    ++version_;
  }
  tighten(fleet.tight);
}

Closures::Closed Closures::now(const Fleet& fleet) const {
  Closed closed{fleet.closed, fleet.zone, fleet.units, {}};
  for (int robot = 0; robot < fleet.size(); ++robot) {
    if (fleet.isStopped(robot)) closed.cells.push_back(fleet.cell[robot]);
  }
  sort(closed.cells);
  sort(closed.zone);
  sort(closed.units);
  for (const Cell unit : closed.units) {
    if (isWaitedFor(unit, fleet)) closed.waiting.push_back(unit);
  }
  return closed;
}

/// Returns whether the nearest robot behind a unit in a lane is loaded.
bool Closures::isWaitedFor(Cell unit, const Fleet& fleet) const {
  std::vector<Cell> behind = before(floor_, unit);
  for (std::size_t i = 0; i < behind.size(); ++i) {
    const auto at = std::find(fleet.cell.begin(), fleet.cell.end(), behind[i]);
    if (at != fleet.cell.end()) return fleet.isLoaded(at - fleet.cell.begin());
    for (const Cell cell : before(floor_, behind[i])) {
      const bool is_new = std::find(behind.begin(), behind.end(), cell) == behind.end();
      if (is_new) behind.push_back(cell);
    }
  }
  return false;
}

/// Returns the cells whose closure has lasted long enough for robots to turn back.
Closures::Closed Closures::lasting(const Closed& now) {
  std::map<Cell, int> since;
  const auto chosen = [&](const std::vector<Cell>& cells) {
    std::vector<Cell> lasting;
    for (const Cell cell : cells) {
      const auto known = since_.find(cell);
      const int begin = known == since_.end() ? tick_ : known->second;
      since.emplace(cell, begin);
      if (tick_ - begin >= kLasting) lasting.push_back(cell);
    }
    return lasting;
  };
  Closed lasting{chosen(now.cells), {}, chosen(now.units), {}};
  since_ = std::move(since);
  return lasting;
}

/// Restores the edges of the floor.
void Closures::open() {
  for (const Deck deck : {Deck::kUnder, Deck::kAisles}) {
    auto& next = edges_.next[static_cast<int>(deck)];
    auto& against = edges_.against[static_cast<int>(deck)];
    for (const int edge : against) next[edge] = kNowhere;
    against.clear();
    set(deck, closed_.cells, true);
    set(deck, closed_.zone, true);
  }
  set(Deck::kAisles, closed_.units, true);
  set(Deck::kUnder, closed_.waiting, true);
}

void Closures::close() {
  std::vector<Cell> cut = lasting_.cells;
  cut.insert(cut.end(), lasting_.units.begin(), lasting_.units.end());
  cut.insert(cut.end(), closed_.zone.begin(),
             closed_.zone.end());  // closed for long from the start
  sort(cut);
  const std::vector<BackEdge> back = waysBack(floor_, cut);
  leadBack(Deck::kUnder, back);
  leadBack(Deck::kAisles, back);
  std::vector<Cell> units = lasting_.units;
  units.insert(units.end(), closed_.waiting.begin(), closed_.waiting.end());
  leadBack(Deck::kUnder, waysToUnits(floor_, lasting_.cells, units));
  for (const Cell unit : closed_.waiting) comeFromBeyond(unit);
  for (const Deck deck : {Deck::kUnder, Deck::kAisles}) {
    fence(deck, closed_.zone);
    set(deck, closed_.cells, false);
  }
  set(Deck::kAisles, closed_.units, false);
}

/// Opens or closes the edges of the floor that lead into cells.
void Closures::set(Deck deck, const std::vector<Cell>& cells, bool is_open) {
  auto& next = edges_.next[static_cast<int>(deck)];
  for (const Cell cell : cells) {
    for (int heading = 0; heading < kHeadings; ++heading) {
      const Cell from = floor_.beside(cell, heading + 2);
      if (from == kNowhere) continue;
      next[from * kHeadings + heading] = is_open ? floor_.next(deck, from, heading) : kNowhere;
    }
  }
}

/// Closes the edges that lead into a zone (sorted) from outside; those within and out of it stay.
void Closures::fence(Deck deck, const std::vector<Cell>& zone) {
  auto& next = edges_.next[static_cast<int>(deck)];
  for (const Cell cell : zone) {
    for (int heading = 0; heading < kHeadings; ++heading) {
      const Cell from = floor_.beside(cell, heading + 2);
      if (from == kNowhere || std::binary_search(zone.begin(), zone.end(), from)) continue;
      next[from * kHeadings + heading] = kNowhere;
    }
  }
}

/// Closes the way along its lane to a unit: the robots that wait behind it fill the lane.
void Closures::comeFromBeyond(Cell unit) {
  auto& next = edges_.next[static_cast<int>(Deck::kUnder)];
  for (const Cell from : before(floor_, unit)) {
    for (int heading = 0; heading < kHeadings; ++heading) {
      if (floor_.beside(from, heading) == unit) next[from * kHeadings + heading] = kNowhere;
    }
  }
}

/// Opens edges against one-way streets.
void Closures::leadBack(Deck deck, const std::vector<BackEdge>& edges) {
  auto& next = edges_.next[static_cast<int>(deck)];
  for (const BackEdge& back : edges) {
    const int edge = back.from * kHeadings + back.heading;
    if (next[edge] != kNowhere) continue;
    next[edge] = floor_.beside(back.from, back.heading);
    edges_.against[static_cast<int>(deck)].push_back(edge);
  }
}

void Closures::tighten(const std::vector<Cell>& cells) {
  if (cells == tight_) return;
  edges_.is_tight.assign(cells.empty() ? 0 : floor_.size(), 0);
  for (const Cell cell : cells) edges_.is_tight[cell] = 1;
  tight_ = cells;
  ++version_;
}

}  // namespace fleet
