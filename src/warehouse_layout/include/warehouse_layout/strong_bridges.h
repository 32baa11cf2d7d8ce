// SPDX-License-Identifier: Apache-2.0
//
// Which parts of a directed graph are strongly connected, and which edges hold them together.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "warehouse_layout/floor.h"

namespace layout {

/// The nodes to which edges lead from each node, kNowhere where there are fewer than four.
using Neighbours = std::vector<std::array<Cell, kHeadings>>;

/// Returns the number of the strongly connected part in which each node is. `back` has the edges of
/// `ahead` reversed. Linear in the number of nodes.
std::vector<int> strongParts(const Neighbours& ahead, const Neighbours& back);

/// Finds the edges without which their part were no longer strongly connected. Such an edge is on
/// all ways from any one node of the part to its end, or from its begin to that node (Italiano,
/// Laura and Santaroni, 2012), so that two trees of dominators tell all of them.
class StrongBridges {
 public:
  /// `part` is what strongParts() returned.
  StrongBridges(const Neighbours& ahead, const Neighbours& back, const std::vector<int>& part);

  /// Tells whether there is no way from node `from` to `to` of one part but the edge between them.
  bool has(Cell from, Cell to) const {
    return only_way_in_[to] == from || only_way_out_[from] == to;
  }

 private:
  std::vector<Cell> only_way_in_, only_way_out_;  // of each node; kNowhere: there are others
};

}  // namespace layout
