// SPDX-License-Identifier: Apache-2.0
//
// Operations: all that one robot can do in a few ticks, as Yukhnevich and Andreychuk, Enhancing
// PIBT via Multi-Action Operations (AAAI 2026), have it. Two that pass the same cells at the same
// ticks and end with the same heading are one.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "warehouse_fleet/fleet.h"

namespace fleet {

constexpr int kMaxDepth = 5;    ///< ticks of an operation
constexpr int kMaxHorizon = 7;  ///< ticks of a plan: what is committed, and an operation
using Actions = std::array<Action, kMaxHorizon>;

/// The cells that one passes, relative to how it stands: a tree whose leaves are operations.
class Operations {
 public:
  explicit Operations(int depth);  ///< of 1 to kMaxDepth ticks

  static constexpr std::uint8_t kStay = 4;
  struct Node {
    std::int16_t parent;  ///< the tick before; -1: where it stands
    std::uint8_t move;    ///< quarters from its heading in which it drives, or kStay
    std::uint8_t tick;    ///< 0 for the first
    std::int16_t leaf;    ///< which leaf, at the last tick; else -1
  };
  struct Leaf {
    std::int16_t node;
    /// For each heading, relative to the first, with which it can end.
    std::array<bool, kHeadings> ends{};
    std::array<Actions, kHeadings> actions{};
    int late = 0;  ///< sum of the ticks in which it drives: less is earlier
  };

  int depth() const { return depth_; }
  const std::vector<Node>& nodes() const { return nodes_; }
  const std::vector<Leaf>& leaves() const { return leaves_; }

 private:
  void grow(int parent, int tick, int heading, Actions& actions);
  void end(int node, int heading, const Actions& actions);
  int child(int parent, int move, int tick);

  int depth_;
  std::vector<Node> nodes_;
  std::vector<Leaf> leaves_;
};

}  // namespace fleet
