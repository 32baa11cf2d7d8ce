// SPDX-License-Identifier: Apache-2.0
//
// What each edge of the floor costs: a tick, and more against the traffic. Learnt while robots
// drive, after Chen et al., Traffic Flow Optimisation for Lifelong Multi-Agent Path Finding (2024):
// aisles find their direction by themselves, and crowds are driven around.
#pragma once

#include <cstdint>
#include <vector>

#include "warehouse_fleet/floor.h"

namespace fleet {

/// A tick in the units of all costs: fine enough for what guidance adds to one.
constexpr int kTickCost = 6;
/// No edge costs more.
constexpr int kMaxEdgeCost = 60;

struct GuidanceOptions {
  double against = 0;   ///< cost of meeting one robot a tick, in ticks
  double crowd = 0;     ///< cost of one robot a tick that waits in the cell, in ticks
  double resting = 0;   ///< cost of a cell where a robot is where it was to go, in ticks
  double at_lanes = 0;  ///< cost beside stations' lanes, which is for who goes there, in ticks
  double memory = 200;  ///< ticks after which what was seen counts 1/e
};

class Guidance {
 public:
  Guidance(const Floor& floor, const GuidanceOptions& options);

  /// A robot drove from `cell` towards `heading` in this tick, or waited there.
  void drove(Cell cell, int heading) { drove_[cell * kHeadings + heading] += gain_; }
  void waited(Cell cell) { waited_[cell] += gain_; }
  /// A robot has come to its goal and stands there until it gets another.
  void rests(Cell cell) { resting_.push_back(cell); }
  /// The tick is over.
  void tick();

  /// Computes the costs again from the traffic seen.
  void refresh();
  /// By cell and heading, in kTickCost.
  const std::vector<std::uint8_t>& costs() const { return costs_; }

 private:
  const Floor& floor_;
  GuidanceOptions options_;
  // What is seen counts more and more instead of what was seen less and less.
  double gain_ = 1;
  std::vector<float> drove_, waited_;
  std::vector<Cell> resting_;  ///< now
  std::vector<std::uint8_t> is_at_lanes_;
  std::vector<std::uint8_t> costs_;
};

}  // namespace fleet
