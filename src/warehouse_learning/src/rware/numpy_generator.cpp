// SPDX-License-Identifier: Apache-2.0
#include "rware/numpy_generator.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace rware {
namespace {

constexpr unsigned __int128 kMultiplier =
    (static_cast<unsigned __int128>(2549297995355413924ULL) << 64) + 4865540595714422341ULL;
// Sizes from which numpy shuffles the end of a range instead of drawing one by one.
constexpr int kLargeRange = 10000, kLargeShare = 50;

std::uint64_t maskOver(std::uint64_t value) {
  for (int shift = 1; shift < 64; shift *= 2) value |= value >> shift;
  return value;
}

}  // namespace

std::uint64_t NumpyGenerator::next64() {
  state_.state = state_.state * kMultiplier + state_.increment;
  const auto high = static_cast<std::uint64_t>(state_.state >> 64);
  const auto folded = high ^ static_cast<std::uint64_t>(state_.state);
  const auto turn = static_cast<unsigned>(high >> 58);
  return (folded >> turn) | (folded << ((64 - turn) & 63));
}

std::uint32_t NumpyGenerator::next32() {
  state_.has_half = !state_.has_half;
  if (!state_.has_half) return state_.half;
  const std::uint64_t both = next64();
  state_.half = static_cast<std::uint32_t>(both >> 32);
  return static_cast<std::uint32_t>(both);
}

std::uint32_t NumpyGenerator::upTo(std::uint32_t last) {
  if (last == 0) return 0;  // nothing is drawn
  const std::uint32_t count = last + 1;
  std::uint64_t product = std::uint64_t{next32()} * count;
  if (static_cast<std::uint32_t>(product) < count) {
    const std::uint32_t least = (UINT32_MAX - last) % count;
    while (static_cast<std::uint32_t>(product) < least) product = std::uint64_t{next32()} * count;
  }
  return static_cast<std::uint32_t>(product >> 32);
}

int NumpyGenerator::integer(int count) { return static_cast<int>(upTo(count - 1)); }

std::vector<int> NumpyGenerator::choice(int count, int size) {
  if (count <= kLargeRange || size <= count / kLargeShare) return byFloyd(count, size);
  std::vector<int> all(count);
  std::iota(all.begin(), all.end(), 0);
  shuffle(&all, std::max(count - size, 1));
  return {all.end() - size, all.end()};
}

void NumpyGenerator::shuffle(std::vector<int>* values, int first) {
  for (int i = static_cast<int>(values->size()) - 1; i >= first; --i) {
    std::swap((*values)[i], (*values)[upTo(i)]);
  }
}

std::vector<int> NumpyGenerator::byFloyd(int count, int size) {
  std::vector<int> chosen;
  chosen.reserve(size);
  // numpy keeps taken values in a hash set, of which only membership matters.
  const std::uint64_t mask = maskOver(static_cast<std::uint64_t>(1.2 * size));
  std::vector<int> taken(mask + 1, -1);
  const auto placeOf = [&](int value) {
    std::uint64_t at = value & mask;
    while (taken[at] != -1 && taken[at] != value) at = (at + 1) & mask;
    return at;
  };
  for (int last = count - size; last < count; ++last) {
    int value = static_cast<int>(upTo(last));
    if (taken[placeOf(value)] == value) value = last;
    taken[placeOf(value)] = value;
    chosen.push_back(value);
  }
  shuffle(&chosen, 1);
  return chosen;
}

}  // namespace rware
