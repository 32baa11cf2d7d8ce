// SPDX-License-Identifier: Apache-2.0
//
// Observations of agents: RWARE's flattened vectors and images.
#pragma once

#include <cstdint>
#include <vector>

#include "rware/warehouse.h"

namespace rware {

/// The layers, numbered as RWARE's ImageLayer.
enum class Layer : int {
  kShelves,
  kRequests,
  kAgents,
  kAgentDirection,
  kAgentLoad,
  kGoals,
  kAccessible
};

/// The range of agents' view, in cells to each side, and the number of bits of their messages.
struct Senses {
  int range = 1;
  int bits = 0;
  bool normalised = false;  ///< Positions are shares of the floor instead of cells.

  int width() const { return 1 + 2 * range; }
  int cells() const { return width() * width(); }
  /// Returns the length of a vector: 8 numbers of the agent itself, then for each cell 7 and the
  /// message's bits.
  int size() const { return 8 + cells() * (7 + bits); }
};

/// Writes an agent's view as a vector of senses.size(): x, y, whether it carries, direction one
/// hot, whether on a highway; then for each cell around, row by row: an agent, its direction one
/// hot, its message, a shelf, whether that is requested. messages: agents * bits.
void writeVector(const Warehouse& warehouse, const Senses& senses, const float* messages, int agent,
                 float* out);

/// Writes an agent's view as layers of width * width; rotated so that ahead is up if `directional`.
void writeImage(const Warehouse& warehouse, const Senses& senses, const std::vector<Layer>& layers,
                bool directional, int agent, float* out);

/// Writes direction one hot, whether on a highway, whether it carries: 6 numbers.
void writeFeatures(const Warehouse& warehouse, int agent, float* out);
constexpr int kFeatures = 6;

}  // namespace rware
