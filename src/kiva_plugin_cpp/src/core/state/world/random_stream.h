// SPDX-License-Identifier: Apache-2.0
//
// Random numbers that belong to a matter, such as one robot's scan at one step, and not to who
// asked before: the same however many threads there are, and with nothing to keep in a checkpoint.
#pragma once

#include <cmath>
#include <cstdint>

namespace kiva {

/// What numbers are drawn for: each its own stream. Append only, so that runs stay what they were.
enum class Matter : std::uint64_t {
  kCalibration = 1,
  kSlip = 2,
  kCode = 3,
  kLaser = 4,
  kActuation = 5,
  kCommand = 6,
  kStatus = 7,
  kEnergy = 8,
  kFailure = 9,
  kPeople = 10,
  kFloor = 11,
  kItem = 12
};

/// SplitMix64 (Steele, Lea, Flood 2014), begun from a hash of what it is for.
class RandomStream {
 public:
  /// `who`: the subject, such as a robot's id; `when`: a step or a counter.
  RandomStream(std::uint64_t seed, Matter matter, std::uint64_t who, std::uint64_t when)
      : state_(seed) {
    for (const std::uint64_t word : {static_cast<std::uint64_t>(matter), who, when}) {
      state_ = next() ^ word;
    }
    next();
  }

  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15ULL;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    return z ^ (z >> 31);
  }

  /// In [0, 1).
  double uniform() { return static_cast<double>(next() >> 11) * 0x1.0p-53; }
  bool chance(double probability) { return uniform() < probability; }
  /// Returns a number of the standard normal distribution (Box and Muller 1958).
  double normal() {
    const double radius = std::sqrt(-2 * std::log(1 - uniform()));
    return radius * std::cos(2 * M_PI * uniform());
  }
  double exponential(double mean) { return -mean * std::log(1 - uniform()); }

 private:
  std::uint64_t state_;
};

}  // namespace kiva
