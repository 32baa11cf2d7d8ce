// SPDX-License-Identifier: Apache-2.0
//
// Operations: all that one robot can do in a few ticks (Yukhnevich and Andreychuk, Enhancing PIBT
// via Multi-Action Operations, AAAI 2026). Sequences of actions that pass the same cells at the
// same ticks and end with the same heading are one operation.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "warehouse_fleet/fleet.h"

namespace fleet {

constexpr int kMaxDepth = 5;    ///< ticks of an operation
constexpr int kMaxHorizon = 7;  ///< ticks of a plan: committed actions, then an operation
using Actions = std::array<Action, kMaxHorizon>;

/// The cells that operations pass, relative to the robot's pose: a tree with operations as leaves.
class Operations {
 public:
  explicit Operations(int depth);  ///< `depth`: 1 to kMaxDepth ticks

  static constexpr std::uint8_t kStay = 4;
  struct Node {
    std::int16_t parent;  ///< node of the tick before; -1 = the robot's cell
    std::uint8_t move;    ///< direction of the drive in quarters from the heading, or kStay
    std::uint8_t tick;    ///< 0 for the first
    std::int16_t leaf;    ///< index of the leaf at the last tick; else -1
  };
  struct Leaf {
    std::int16_t node;
    /// Whether the operation can end with each final heading, relative to the first one.
    std::array<bool, kHeadings> ends{};
    std::array<Actions, kHeadings> actions{};
    int late = 0;  ///< sum of the ticks of drives, less for earlier drives
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
