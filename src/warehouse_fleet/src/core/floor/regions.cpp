// SPDX-License-Identifier: Apache-2.0
#include "core/floor/regions.h"

#include <algorithm>
#include <cstdlib>
#include <limits>

namespace fleet {
namespace {

bool carries(const Floor& floor, Deck deck, Cell cell) {
  if (!floor.isPassable(cell) || floor.isLane(cell)) return false;
  return deck == Deck::kUnder || !(floor.isStorage(cell) || floor.isParking(cell));
}

/// Returns and marks the cells connected with `start`, whatever the direction of edges.
std::vector<Cell> part(const Floor& floor, Deck deck, Cell start,
                       std::vector<std::uint8_t>& visited) {
  std::vector<Cell> cells{start};
  visited[start] = 1;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    for (int heading = 0; heading < kHeadings; ++heading) {
      const Cell beside = floor.beside(cells[i], heading);
      if (beside == kNowhere || visited[beside] || !carries(floor, deck, beside)) continue;
      const bool is_joined = floor.next(deck, cells[i], heading) == beside ||
                             floor.next(deck, beside, turned(heading, 2)) == cells[i];
      if (!is_joined) continue;
      visited[beside] = 1;
      cells.push_back(beside);
    }
  }
  return cells;
}

std::vector<Cell> largestPart(const Floor& floor, Deck deck) {
  std::vector<std::uint8_t> visited(floor.size());
  std::vector<Cell> largest;
  for (Cell cell = 0; cell < floor.size(); ++cell) {
    if (visited[cell] || !carries(floor, deck, cell)) continue;
    std::vector<Cell> cells = part(floor, deck, cell, visited);
    if (cells.size() > largest.size()) largest.swap(cells);
  }
  return largest;
}

}  // namespace

Regions::Regions(const Floor& floor, int side)
    : floor_(floor),
      side_(side),
      columns_((floor.width() + side - 1) / side),
      rows_((floor.height() + side - 1) / side) {
  for (const Deck deck : {Deck::kUnder, Deck::kAisles}) find(deck);
}

int Regions::count(const Floor& floor, int side) {
  const int columns = (floor.width() + side - 1) / side, rows = (floor.height() + side - 1) / side;
  std::vector<std::uint8_t> has_cells(columns * rows);
  for (Cell cell = 0; cell < floor.size(); ++cell) {
    if (floor.isPassable(cell))
      has_cells[floor.y(cell) / side * columns + floor.x(cell) / side] = 1;
  }
  return static_cast<int>(std::count(has_cells.begin(), has_cells.end(), 1));
}

Cell Regions::nearestMiddle(Deck deck, Cell cell) const {
  const int column = floor_.x(cell) / side_, row = floor_.y(cell) / side_;
  Cell nearest = kNowhere;
  const auto away = [&](Cell other) {
    return std::abs(floor_.x(other) - floor_.x(cell)) + std::abs(floor_.y(other) - floor_.y(cell));
  };
  for (int y = std::max(0, row - 1); y <= std::min(rows_ - 1, row + 1); ++y) {
    for (int x = std::max(0, column - 1); x <= std::min(columns_ - 1, column + 1); ++x) {
      const Cell other = middle(deck, y * columns_ + x);
      if (other == kNowhere) continue;
      if (nearest == kNowhere || away(other) < away(nearest)) nearest = other;
    }
  }
  return nearest;
}

void Regions::find(Deck deck) {
  std::vector<Cell>& middles = middles_[static_cast<int>(deck)];
  middles.assign(size(), kNowhere);
  std::vector<int> nearest(size(), std::numeric_limits<int>::max());
  for (const Cell cell : largestPart(floor_, deck)) {
    const int region = of(cell), half = side_ / 2;
    const int away =
        std::abs(floor_.x(cell) % side_ - half) + std::abs(floor_.y(cell) % side_ - half);
    const bool is_nearer =
        away < nearest[region] || (away == nearest[region] && cell < middles[region]);
    if (!is_nearer) continue;
    nearest[region] = away;
    middles[region] = cell;
  }
}

}  // namespace fleet
