// SPDX-License-Identifier: Apache-2.0
#include "rware/undertaking.h"

#include <algorithm>
#include <cstdlib>

namespace rware {

void Undertaking::begin(const Warehouse& warehouse, const std::int8_t* actions,
                        std::int8_t* current) {
  const int agents = static_cast<int>(warehouse.agents().size());
  held_.clear();
  for (int i = 0; i < agents; ++i) {
    if (current[i] == kForward) held_.push_back(warehouse.ahead(warehouse.agents()[i]));
  }
  for (int i = 0; i < agents; ++i) {
    if (current[i] != kNoop || !mayBegin(warehouse, i, actions[i], current)) continue;
    current[i] = actions[i];
    if (actions[i] == kForward) held_.push_back(warehouse.ahead(warehouse.agents()[i]));
  }
}

bool Undertaking::mayBegin(const Warehouse& warehouse, int agent, int action,
                           const std::int8_t* current) const {
  const Agent& own = warehouse.agents()[agent];
  switch (action) {
    case kForward:
      return mayGo(warehouse, agent);
    case kLeft:
    case kRight:
      return !bodies_ || mayTurn(warehouse, agent, current);
    case kToggleLoad:
      return own.shelf >= 0 ? !warehouse.layout().highway[own.cell]
                            : warehouse.shelfAt(own.cell) >= 0;
    default:
      return false;
  }
}

bool Undertaking::mayGo(const Warehouse& warehouse, int agent) const {
  const Agent& own = warehouse.agents()[agent];
  const int target = warehouse.ahead(own);
  return target != own.cell && warehouse.agentAt(target) < 0 &&
         std::find(held_.begin(), held_.end(), target) == held_.end() &&
         (own.shelf < 0 || warehouse.shelfAt(target) < 0);
}

bool Undertaking::mayTurn(const Warehouse& warehouse, int agent, const std::int8_t* current) const {
  const Layout& layout = warehouse.layout();
  const auto& agents = warehouse.agents();
  const int cell = agents[agent].cell;
  for (std::size_t i = 0; i < agents.size(); ++i) {
    const bool turns = current[i] == kLeft || current[i] == kRight;
    const int columns = std::abs(layout.x(agents[i].cell) - layout.x(cell));
    const int rows = std::abs(layout.y(agents[i].cell) - layout.y(cell));
    if (turns && columns + rows == 1) return false;
  }
  return true;
}

}  // namespace rware
