// SPDX-License-Identifier: Apache-2.0
//
// The cost of each edge of the floor: a tick, and more against the traffic. It is learnt while
// robots drive (Chen et al., Traffic Flow Optimisation for Lifelong Multi-Agent Path Finding,
// 2024): aisles become one-way by themselves, and robots drive around crowds. From the beginning it
// costs more to drive against the directions that narrow streets are given (streets.h); what is
// learnt counts less in these.
#pragma once

#include <cstdint>
#include <vector>

#include "core/floor/streets.h"
#include "warehouse_fleet/floor.h"

namespace fleet {

/// The cost of a tick, which leaves room for the fractions that guidance adds.
constexpr int kTickCost = 6;
/// The highest cost of an edge.
constexpr int kMaxEdgeCost = 60;

struct GuidanceOptions {
  double crowd = 0;    ///< cost of a cell in which one robot a tick waits, in ticks
  double resting = 0;  ///< cost of a cell where a robot rests at its goal, in ticks
  double at_lanes =
      0;  ///< cost beside stations' lanes, except for robots on their way there, in ticks
  double streets = 0;   ///< cost against the direction of a narrow street, in ticks
  double memory = 200;  ///< ticks after which traffic counts 1/e
};

class Guidance {
 public:
  Guidance(const Floor& floor, const GuidanceOptions& options);

  /// Records that a robot drove from `cell` towards `heading` in this tick, or waited there.
  void drove(Cell cell, int heading) { drove_[cell * kHeadings + heading] += gain_; }
  void waited(Cell cell) { waited_[cell] += gain_; }
  /// Records that a robot stands at its goal until it gets another.
  void rests(Cell cell) { resting_.push_back(cell); }
  /// Ends the tick.
  void tick();

  /// Updates the costs by the recorded traffic. against: cost of one oncoming robot a tick, in
  /// ticks.
  void refresh(double against);
  /// Returns the costs by cell and heading [kTickCost].
  const std::vector<std::uint8_t>& costs() const { return costs_; }

 private:
  StreetWay streetWay(std::size_t edge) const {
    return street_ways_.empty() ? StreetWay::kNone : street_ways_[edge];
  }
  /// Returns the cost of driving against the edge's street [ticks].
  double againstStreet(std::size_t edge) const {
    return streetWay(edge) == StreetWay::kAgainst ? options_.streets : 0;
  }

  const Floor& floor_;
  GuidanceOptions options_;
  // Weight of new traffic. It grows, so that old traffic need not be reduced at every tick.
  double gain_ = 1;
  std::vector<float> drove_, waited_;
  std::vector<Cell> resting_;  ///< in this tick
  std::vector<std::uint8_t> is_at_lanes_;
  std::vector<StreetWay> street_ways_;  ///< empty without streets
  std::vector<std::uint8_t> costs_;
};

}  // namespace fleet
