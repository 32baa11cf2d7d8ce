// SPDX-License-Identifier: Apache-2.0
//
// The order in which Python iterates over a set of grid cells.
#pragma once

#include <cstdint>
#include <vector>

namespace rware {

/// Returns hash((x, y)) of CPython 3.8 and later, for x, y >= 0.
std::uint64_t hashOfPair(int x, int y);

/// A set with the layout of CPython 3.8 to 3.14: open addressing with short linear probes. RWARE
/// lets the order of such a set decide which of two robots enters a cell, so the order is part of
/// its rules.
class PythonSet {
 public:
  PythonSet() : table_(kLeast) {}
  /// Adds a cell by its number, unless it is there already.
  void add(int cell, std::uint64_t hash);
  bool contains(int cell, std::uint64_t hash) const;
  std::size_t size() const { return used_; }

  /// Calls visit(cell, hash) for each cell, in Python's order.
  template <typename Visit>
  void forEach(const Visit& visit) const {
    for (const Entry& entry : table_) {
      if (entry.cell >= 0) visit(entry.cell, entry.hash);
    }
  }

 private:
  static constexpr std::size_t kLeast = 8;
  struct Entry {
    int cell = -1;
    std::uint64_t hash = 0;
  };
  std::size_t find(int cell, std::uint64_t hash) const;  // the cell's slot, or the free one for it
  void grow();

  std::vector<Entry> table_;
  std::size_t used_ = 0;
};

}  // namespace rware
