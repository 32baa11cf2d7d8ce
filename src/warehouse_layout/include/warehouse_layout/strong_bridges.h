// SPDX-License-Identifier: Apache-2.0
//
// The strongly connected parts of a directed graph, and the edges that hold them together.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "warehouse_layout/floor.h"

namespace layout {

/// The successors of each node, kNowhere in place of missing ones.
using Neighbours = std::vector<std::array<Cell, kHeadings>>;

/// Returns the number of each node's strongly connected part. `back` has the edges of `ahead`
/// reversed. Linear in the number of nodes.
std::vector<int> strongParts(const Neighbours& ahead, const Neighbours& back);

/// Finds the edges without which their part would not be strongly connected. Such an edge is on all
/// ways from any one node of the part to the edge's end, or from its begin to that node (Italiano,
/// Laura and Santaroni, 2012), so that two trees of dominators contain all of them.
class StrongBridges {
 public:
  /// `part` is the result of strongParts().
  StrongBridges(const Neighbours& ahead, const Neighbours& back, const std::vector<int>& part);

  /// Returns whether the edge is the only way from node `from` to `to` of one part.
  bool has(Cell from, Cell to) const {
    return only_way_in_[to] == from || only_way_out_[from] == to;
  }

 private:
  std::vector<Cell> only_way_in_, only_way_out_;  // by node; kNowhere: there are several
};

}  // namespace layout
