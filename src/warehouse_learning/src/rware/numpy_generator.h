// SPDX-License-Identifier: Apache-2.0
//
// The random stream of numpy: the same seed gives the same numbers.
#pragma once

#include <cstdint>
#include <vector>

namespace rware {

/// Continues a numpy.random.Generator over PCG64 from the state of its bit generator.
///
/// PCG64 is PCG XSL RR 128/64 (O'Neill, "PCG: A Family of Simple Fast Space-Efficient Statistically
/// Good Algorithms for Random Number Generation", 2014); bounded integers follow Lemire, "Fast
/// Random Integer Generation in an Interval", 2019; draws without replacement follow Floyd
/// (Bentley, "Programming Pearls", 1987).
class NumpyGenerator {
 public:
  /// The state of numpy.random.PCG64().
  struct State {
    unsigned __int128 state = 0, increment = 1;
    bool has_half = false;   ///< Whether half of the last 64 bits is unused.
    std::uint32_t half = 0;  ///< The unused half.
  };

  NumpyGenerator() = default;
  explicit NumpyGenerator(const State& state) : state_(state) {}
  const State& state() const { return state_; }

  /// Draws as Generator.integers(0, count) does; count is 1 or more.
  int integer(int count);
  /// Draws as Generator.choice(count, size, replace=False) does; size is at most count.
  std::vector<int> choice(int count, int size);

 private:
  std::uint64_t next64();
  std::uint32_t next32();
  std::uint32_t upTo(std::uint32_t last);  // 0 … last
  void shuffle(std::vector<int>* values, int first);
  std::vector<int> byFloyd(int count, int size);

  State state_;
};

}  // namespace rware
