// SPDX-License-Identifier: Apache-2.0
#include "core/geometry/loose_grid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace kiva {
namespace {

constexpr float kLargest = 2048;  // side of the grid [m]; cells of a larger one would take too much
constexpr float kMargin = 32;     // [m], so that a driver at the rim seldom makes the grid grow
constexpr float kGrowth = 0.25f;  // share of the grid by which it grows at least

/// A margin against the rounding of a cell's index, relative to a cell.
constexpr float kRounding = 0.001f;
constexpr int kBits = 64;
constexpr int kShift = 6;  // of a column, to its word of bits

/// Boxes beyond the grid are in its outermost cells: both they and areas are clamped.
int clamped(float cells, int count) {
  return cells > 0 ? static_cast<int>(std::min(cells, static_cast<float>(count - 1))) : 0;
}

/// Returns the bits of columns `first` to `last` that lie in a word.
std::uint64_t within(int first, int last, int word) {
  const int low = std::max(first - (word << kShift), 0);
  const int high = std::min(last - (word << kShift), kBits - 1);
  return (~std::uint64_t{0} << low) & (~std::uint64_t{0} >> (kBits - 1 - high));
}

}  // namespace

void LooseGrid::clear() { *this = LooseGrid(); }

void LooseGrid::find(const AxisBox& area, Handles* handles) const {
  for (unsigned levels = used_; levels != 0; levels &= levels - 1) {
    const Level& level = levels_[__builtin_ctz(levels)];
    const Range x = columns(level, area.min_x, area.max_x);
    const Range y = rows(level, area.min_y, area.max_y);
    for (int row = y.first; row <= y.last; ++row) findInRow(level, row, x, area, handles);
  }
}

inline void LooseGrid::findInRow(const Level& level, int row, const Range& columns,
                                 const AxisBox& area, Handles* handles) const {
  const std::uint64_t* occupied = &level.occupied[row * level.words];
  const Cell* cells = &level.cells[row * level.width];
  for (int word = columns.first >> kShift; word <= columns.last >> kShift; ++word) {
    std::uint64_t bits = occupied[word] & within(columns.first, columns.last, word);
    for (; bits != 0; bits &= bits - 1) {
      const Cell& cell = cells[(word << kShift) + __builtin_ctzll(bits)];
      const Item* item = cell.data();
      for (const Item* end = item + cell.size(); item != end; ++item) {
        if (item->box.meets(area)) handles->push_back(item->handle);
      }
    }
  }
}

LooseGrid::Range LooseGrid::columns(const Level& level, float from, float to) const {
  return {clamped((from - level.loose - origin_x_) * level.per_cell, level.width),
          clamped((to + level.loose - origin_x_) * level.per_cell, level.width)};
}

LooseGrid::Range LooseGrid::rows(const Level& level, float from, float to) const {
  return {clamped((from - level.loose - origin_y_) * level.per_cell, level.height),
          clamped((to + level.loose - origin_y_) * level.per_cell, level.height)};
}

LooseGrid::Location& LooseGrid::at(int handle) {
  std::vector<Location>& places = handle < 0 ? robots_ : entries_;
  const std::size_t index = handle < 0 ? ~handle : handle;
  if (index >= places.size()) places.resize(index + 1);
  return places[index];
}

void LooseGrid::put(int handle, const AxisBox& box) {
  cover(box.min_x + (box.max_x - box.min_x) / 2, box.min_y + (box.max_y - box.min_y) / 2);
  Location& place = at(handle);
  const Location next = cellOf(box);
  if (place.level == next.level && place.cell == next.cell) {
    levels_[place.level].cells[place.cell][place.index].box = box;
    return;
  }
  remove(handle);
  insert(handle, box, &place);
}

void LooseGrid::remove(int handle) {
  Location& place = at(handle);
  if (place.level < 0) return;
  Level& level = levels_[place.level];
  Cell& items = level.cells[place.cell];
  items[place.index] = items.back();
  at(items[place.index].handle).index = place.index;
  items.pop_back();
  if (--level.count == 0) used_ &= ~(1u << place.level);
  if (items.empty()) {
    const int row = place.cell / level.width, column = place.cell % level.width;
    level.occupied[row * level.words + (column >> kShift)] &=
        ~(std::uint64_t{1} << (column & (kBits - 1)));
  }
  place = Location();
}

void LooseGrid::insert(int handle, const AxisBox& box, Location* place) {
  *place = cellOf(box);
  Level& level = levels_[place->level];
  Cell& items = level.cells[place->cell];
  place->index = static_cast<int>(items.size());
  items.push_back({box, handle});
  ++level.count;
  used_ |= 1u << place->level;
  const int row = place->cell / level.width, column = place->cell % level.width;
  level.occupied[row * level.words + (column >> kShift)] |= std::uint64_t{1}
                                                            << (column & (kBits - 1));
}

LooseGrid::Location LooseGrid::cellOf(const AxisBox& box) const {
  const float size = std::max(box.max_x - box.min_x, box.max_y - box.min_y);
  Location out;
  out.level = 0;
  while (out.level < kLevels - 1 && !(size <= levels_[out.level].cell)) ++out.level;
  const Level& level = levels_[out.level];
  const float x = box.min_x + (box.max_x - box.min_x) / 2;
  const float y = box.min_y + (box.max_y - box.min_y) / 2;
  const int column = clamped((x - origin_x_) * level.per_cell, level.width);
  out.cell = clamped((y - origin_y_) * level.per_cell, level.height) * level.width + column;
  return out;
}

/// Makes the grid hold that point, unless it would become too large.
void LooseGrid::cover(float x, float y) {
  const bool is_empty = levels_[0].width == 0;
  if (!is_empty && x >= origin_x_ && x <= end_x_ && y >= origin_y_ && y <= end_y_) return;
  const bool is_near = std::abs(x) < kLargest * kLargest && std::abs(y) < kLargest * kLargest;
  if (!is_near) {
    if (is_empty) resize(0, 1, 0, 1);
    return;
  }
  if (is_empty) return resize(x - kMargin, x + kMargin, y - kMargin, y + kMargin);
  const float margin_x = std::max(kMargin, kGrowth * (end_x_ - origin_x_));
  const float margin_y = std::max(kMargin, kGrowth * (end_y_ - origin_y_));
  const float min_x = x < origin_x_ ? x - margin_x : origin_x_;
  const float max_x = x > end_x_ ? x + margin_x : end_x_;
  const float min_y = y < origin_y_ ? y - margin_y : origin_y_;
  const float max_y = y > end_y_ ? y + margin_y : end_y_;
  if (max_x - min_x <= kLargest && max_y - min_y <= kLargest) resize(min_x, max_x, min_y, max_y);
}

void LooseGrid::resize(float min_x, float max_x, float min_y, float max_y) {
  std::vector<Item> items;
  for (Level& level : levels_) {
    for (const Cell& cell : level.cells) items.insert(items.end(), cell.begin(), cell.end());
  }
  origin_x_ = min_x;
  origin_y_ = min_y;
  end_x_ = max_x;
  end_y_ = max_y;
  used_ = 0;
  float side = kSmallest;
  for (Level& level : levels_) {
    const bool is_last = &level == &levels_.back();
    level = Level();
    level.cell = side;
    level.per_cell = 1 / side;
    level.loose = is_last ? std::numeric_limits<float>::infinity() : side * (0.5f + kRounding);
    level.width = is_last ? 1 : static_cast<int>((max_x - min_x) / side) + 1;
    level.height = is_last ? 1 : static_cast<int>((max_y - min_y) / side) + 1;
    level.words = (level.width + kBits - 1) / kBits;
    level.cells.resize(static_cast<std::size_t>(level.width) * level.height);
    level.occupied.resize(static_cast<std::size_t>(level.words) * level.height);
    side *= 2;
  }
  for (const Item& item : items) insert(item.handle, item.box, &at(item.handle));
}

}  // namespace kiva
