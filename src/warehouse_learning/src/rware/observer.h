// SPDX-License-Identifier: Apache-2.0
//
// What agents see: RWARE's flattened vectors and images.
#pragma once

#include <cstdint>
#include <vector>

#include "rware/warehouse.h"

namespace rware {

/// Numbered as RWARE's ImageLayer.
enum class Layer : int {
  kShelves,
  kRequests,
  kAgents,
  kAgentDirection,
  kAgentLoad,
  kGoals,
  kAccessible
};

/// How far agents see, in cells to each side, and how many bits the messages of agents have.
struct Senses {
  int range = 1;
  int bits = 0;
  bool normalised = false;  ///< Positions as a share of the floor instead of cells.

  int width() const { return 1 + 2 * range; }
  int cells() const { return width() * width(); }
  /// Numbers that a vector has: 8 of the agent itself, then 7 and the message's bits a cell.
  int size() const { return 8 + cells() * (7 + bits); }
};

/// Writes what an agent sees as a vector of senses.size(): x, y, whether it carries, direction one
/// hot, whether on a highway; then of each cell around, row by row: an agent, its direction one
/// hot, its message, a shelf, whether that is requested. messages: agents * bits.
void writeVector(const Warehouse& warehouse, const Senses& senses, const float* messages, int agent,
                 float* out);

/// Writes what an agent sees as layers of width * width; turned so that ahead is up if directional.
void writeImage(const Warehouse& warehouse, const Senses& senses, const std::vector<Layer>& layers,
                bool directional, int agent, float* out);

/// Writes direction one hot, whether on a highway, whether it carries: 6 numbers.
void writeFeatures(const Warehouse& warehouse, int agent, float* out);
constexpr int kFeatures = 6;

}  // namespace rware
