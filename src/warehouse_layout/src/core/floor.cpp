// SPDX-License-Identifier: Apache-2.0
#include "warehouse_layout/floor.h"

#include <limits>

namespace layout {
namespace {

std::vector<std::uint8_t> filled(const std::vector<std::uint8_t>& given, Cell size,
                                 std::uint8_t otherwise, const char* name) {
  if (given.empty()) return std::vector<std::uint8_t>(size, otherwise);
  if (static_cast<Cell>(given.size()) != size) {
    throw FloorError(std::string(name) + " has " + std::to_string(given.size()) +
                     " elements; width * height = " + std::to_string(size) + " were expected");
  }
  return given;
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

int shortest(const Floor& floor, Deck deck, Cell from, Cell to) {
  std::vector<int> distance(floor.size(), -1);
  std::vector<Cell> queue{from};
  distance[from] = 0;
  for (std::size_t i = 0; i < queue.size() && distance[to] < 0; ++i) {
    const Cell cell = queue[i];
    for (int heading = 0; heading < kHeadings; ++heading) {
      const Cell over = floor.next(Deck::kUnder, cell, heading);
      const Cell next = over == to ? to : floor.next(deck, cell, heading);
      if (next == kNowhere || distance[next] >= 0) continue;
      if (isPassingThrough(floor, cell, next, to)) continue;
      distance[next] = distance[cell] + 1;
      queue.push_back(next);
    }
  }
  return distance[to];
}

std::string Floor::name(Cell cell) const {
  if (!has(cell)) return "cell " + std::to_string(cell) + " (off the floor)";
  return "(" + std::to_string(x(cell)) + ", " + std::to_string(y(cell)) + ")";
}

}  // namespace layout
