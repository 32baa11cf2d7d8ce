// SPDX-License-Identifier: Apache-2.0
#include "rware/python_set.h"

#include <utility>

namespace rware {
namespace {

constexpr std::size_t kLinearProbes = 9;
constexpr unsigned kPerturbShift = 5;

}  // namespace

std::uint64_t hashOfPair(int x, int y) {
  // xxHash as in Objects/tupleobject.c; the hash of a small number is that number.
  constexpr std::uint64_t kPrime1 = 11400714785074694791ULL, kPrime2 = 14029467366897019727ULL,
                          kPrime5 = 2870177450012600261ULL;
  std::uint64_t sum = kPrime5;
  for (const int lane : {x, y}) {
    sum += static_cast<std::uint64_t>(lane) * kPrime2;
    sum = (sum << 31) | (sum >> 33);
    sum *= kPrime1;
  }
  sum += 2 ^ (kPrime5 ^ 3527539ULL);
  return sum == UINT64_MAX ? 1546275796 : sum;
}

std::size_t PythonSet::find(int cell, std::uint64_t hash) const {
  const std::size_t mask = table_.size() - 1;
  std::uint64_t perturb = hash;
  std::size_t at = hash & mask;
  for (;;) {
    const std::size_t last = at + kLinearProbes <= mask ? at + kLinearProbes : at;
    for (std::size_t probe = at; probe <= last; ++probe) {
      if (table_[probe].cell < 0 || table_[probe].cell == cell) return probe;
    }
    perturb >>= kPerturbShift;
    at = (at * 5 + 1 + perturb) & mask;
  }
}

bool PythonSet::contains(int cell, std::uint64_t hash) const {
  return table_[find(cell, hash)].cell == cell;
}

void PythonSet::add(int cell, std::uint64_t hash) {
  Entry& entry = table_[find(cell, hash)];
  if (entry.cell == cell) return;
  entry = {cell, hash};
  ++used_;
  if (used_ * 5 >= (table_.size() - 1) * 3) grow();
}

void PythonSet::grow() {
  std::size_t size = kLeast;
  while (size <= used_ * 4) size *= 2;
  const std::vector<Entry> before = std::exchange(table_, std::vector<Entry>(size));
  for (const Entry& entry : before) {
    if (entry.cell >= 0) table_[find(entry.cell, entry.hash)] = entry;
  }
}

}  // namespace rware
