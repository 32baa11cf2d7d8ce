// SPDX-License-Identifier: Apache-2.0
//
// RWARE's actions where they take time: which may begin beside those that are under way.
#pragma once

#include <cstdint>
#include <vector>

#include "rware/warehouse.h"

namespace rware {

/// Lets agents that are at nothing begin an action, in the order of their numbers. An action comes
/// true when it ends: until then its agent stands where it stood, and holds the cell that it goes
/// to. So a cell that is left can be entered once it is empty, by one agent.
class Undertaking {
 public:
  /// bodies: neighbours turn one after the other, since corners of loads would meet.
  explicit Undertaking(bool bodies) : bodies_(bodies) {}
  /// actions, current: one an agent; current, kNoop where an agent is at nothing, gets what begins.
  void begin(const Warehouse& warehouse, const std::int8_t* actions, std::int8_t* current);

 private:
  bool mayBegin(const Warehouse& warehouse, int agent, int action,
                const std::int8_t* current) const;
  bool mayGo(const Warehouse& warehouse, int agent) const;
  bool mayTurn(const Warehouse& warehouse, int agent, const std::int8_t* current) const;

  bool bodies_;
  std::vector<int> held_;  // cells that agents go to
};

}  // namespace rware
