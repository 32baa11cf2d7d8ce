// SPDX-License-Identifier: Apache-2.0
#include "closures.h"

#include <algorithm>
#include <utility>

namespace fleet {

Closures::Closures(const Floor& floor, const std::vector<std::uint8_t>& costs) : floor_(floor) {
  edges_.next[0] = floor.edges(Deck::kUnder);
  edges_.next[1] = floor.edges(Deck::kAisles);
  edges_.costs = &costs;
}

void Closures::update(const Fleet& fleet) {
  std::vector<Cell> under = fleet.closed;
  for (int robot = 0; robot < fleet.size(); ++robot) {
    if (fleet.isStopped(robot)) under.push_back(fleet.cell[robot]);
  }
  std::vector<Cell> aisles = under;
  aisles.insert(aisles.end(), fleet.units.begin(), fleet.units.end());
  close(Deck::kUnder, std::move(under));
  close(Deck::kAisles, std::move(aisles));
  tighten(fleet.tight);
}

void Closures::close(Deck deck, std::vector<Cell> cells) {
  std::sort(cells.begin(), cells.end());
  cells.erase(std::unique(cells.begin(), cells.end()), cells.end());
  std::vector<Cell>& closed = closed_[static_cast<int>(deck)];
  if (cells == closed) return;
  auto& next = edges_.next[static_cast<int>(deck)];
  const auto set = [&](const std::vector<Cell>& those, bool is_open) {
    for (const Cell cell : those) {
      for (int heading = 0; heading < kHeadings; ++heading) {
        const Cell from = floor_.beside(cell, heading + 2);
        if (from == kNowhere) continue;
        next[from * kHeadings + heading] = is_open ? floor_.next(deck, from, heading) : kNowhere;
      }
    }
  };
  set(closed, true);
  set(cells, false);
  closed = std::move(cells);
  ++version_;
}

void Closures::tighten(const std::vector<Cell>& cells) {
  if (cells == tight_) return;
  edges_.is_tight.assign(cells.empty() ? 0 : floor_.size(), 0);
  for (const Cell cell : cells) edges_.is_tight[cell] = 1;
  tight_ = cells;
  ++version_;
}

}  // namespace fleet
