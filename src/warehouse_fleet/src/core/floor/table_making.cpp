// SPDX-License-Identifier: Apache-2.0
//
// The computation of distance tables: whole ones, and near ones that extend a far one.
#include <algorithm>
#include <utility>

#include "core/floor/distance_tables.h"

namespace fleet {
namespace {

/// Limits the cost of each cell in a window to that by way of the region's middle.
void limit(DistanceSearch& search, const Floor& floor, const Window& window,
           const DistanceTable& far, int detour) {
  constexpr int kMost = kUnreachable - 1;
  for (int y = window.top; y < window.top + window.rows; ++y) {
    for (int x = window.left; x < window.left + window.columns; ++x) {
      const Cell cell = y * floor.width() + x;
      if (!far.reaches(cell)) continue;
      for (int heading = 0; heading < kHeadings; ++heading) {
        const int by_middle = std::min(kMost, far.at(cell, heading) + detour);
        if (by_middle < search.cost(cell, heading)) search.set(cell, heading, by_middle);
      }
    }
  }
}

}  // namespace

void DistanceTable::enclose(const Floor& floor, const Window& window, const DistanceTable& far,
                            int detour) {
  far_ = &far;
  detour_ = detour;
  window_ = window;
  width_ = floor.width();
  inverse_ = (std::uint64_t{1} << kInverseBits) / width_ + 1;
}

/// Makes far tables first, since near ones extend them.
void DistanceTables::buildAll(const std::vector<Entry*>& entries) {
  std::vector<Entry*> first, then;
  for (Entry* entry : entries) (entry->kind == Kind::kNear ? then : first).push_back(entry);
  build(first);
  build(then);
}

void DistanceTables::build(const std::vector<Entry*>& entries) {
  threads_.share(static_cast<int>(entries.size()), 1,
                 [&](int i, int thread) { search(*entries[i], *searches_[thread]); });
  for (Entry* entry : entries) {
    const std::size_t bytes = entry->table.words_.size() * sizeof(std::uint32_t) + sizeof(Entry);
    used_ += bytes - std::exchange(entry->bytes, bytes);
  }
}

void DistanceTables::search(Entry& entry, DistanceSearch& search) const {
  if (entry.kind == Kind::kNear) searchNear(entry, search);
  if (entry.kind != Kind::kNear) {
    search.run(entry.deck, entry.goal, whole(floor_), entry.kind == Kind::kFar);
    pack(search, entry.table);
  }
  entry.table.version_ = version_;
  entry.table.made_ = now_;
  entry.is_made = true;
}

/// Computes the cells around a goal, whether or not the way by the region's middle passes them. A
/// goal without a short way from the middle gets a table of all cells.
void DistanceTables::searchNear(Entry& entry, DistanceSearch& search) const {
  const DistanceTable& far = entry.far->table;
  const Cell middle = entry.far->goal;
  const Window window = around(floor_, entry.goal, reach(entry.goal));
  search.run(entry.deck, entry.goal, window, false);
  int detour = 0;
  for (int heading = 0; heading < kHeadings; ++heading) {
    detour = std::max(detour, search.cost(middle, heading));
  }
  if (detour == kUnreachable) {
    entry.kind = Kind::kWhole;
    entry.far = nullptr;
    entry.table.far_ = nullptr;
    return;
  }
  if (!isClosed(entry.deck, middle)) limit(search, floor_, window, far, detour);
  search.pack(entry.table.words_);
  entry.table.enclose(floor_, window, far, detour);
  entry.far_made = far.made_;
}

/// Writes the costs of all cells.
void DistanceTables::pack(const DistanceSearch& search, DistanceTable& table) const {
  if (numbers_ == nullptr) {
    search.pack(table.words_);
  } else {
    search.pack(numbers_->cells, table.words_);
    table.numbers_ = numbers_->of_cell.data();
  }
}

/// Returns whether all edges of the floor into that cell are closed now.
bool DistanceTables::isClosed(Deck deck, Cell cell) const {
  for (int heading = 0; heading < kHeadings; ++heading) {
    const Cell from = floor_.beside(cell, heading + 2);
    if (from == kNowhere) continue;
    if (edges_.next[static_cast<int>(deck)][from * kHeadings + heading] == cell) return false;
  }
  return true;
}

}  // namespace fleet
