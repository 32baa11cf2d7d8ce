// SPDX-License-Identifier: Apache-2.0
//
// RWARE's actions with a duration: arbitration of new actions with those under way.
#pragma once

#include <cstdint>
#include <vector>

#include "rware/warehouse.h"

namespace rware {

/// Begins actions of idle agents, in the order of their numbers. An action takes effect when it
/// ends: until then its agent occupies its cell, and holds the cell that it goes to. So a cell can
/// be entered once it is empty, by one agent.
class Undertaking {
 public:
  /// `bodies`: neighbours turn one after the other, since corners of loads would touch.
  explicit Undertaking(bool bodies) : bodies_(bodies) {}
  /// `actions`, `current`: one an agent. `current` is kNoop for an idle agent and is set to the
  /// action that begins.
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
