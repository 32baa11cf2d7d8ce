// SPDX-License-Identifier: Apache-2.0
#include "goals.h"

namespace learning {

Goals::Goals(const Floor& floor, const State& state)
    : floor_(floor),
      state_(state),
      ways_(floor),
      cell_(state.warehouses(), state.robots()),
      way_(state.warehouses(), state.robots(), nullptr),
      aim_(state.warehouses(), state.robots(), kNone),
      news_(state.warehouses(), 1) {
  for (int cell = 0; cell < floor.size(); ++cell) {
    if (floor.isStorage(cell)) places_.push_back(cell);
  }
}

void Goals::begin(int w) {
  way_.fill(w, nullptr);
  aim_.fill(w, kNone);
  changed(w);
}

void Goals::end(int w, int robot) {
  way_[w][robot] = nullptr;
  aim_[w][robot] = kNone;
  changed(w);
}

void Goals::changed(int w) { news_[w] = 1; }

void Goals::renew() {
  for (int w = 0; w < state_.warehouses(); ++w) {
    const int robots = state_.robots();
    for (int robot = 0; news_[w] && robot < robots; ++robot) {
      if (isGone(w, robot)) end(w, robot);
    }
    if (news_[w]) findOpen(w);
    for (int robot = 0; robot < robots; ++robot) {
      if (way_[w][robot]) continue;
      cell_[w][robot] = state_.cell[w][robot];
      if (news_[w]) find(w, robot);
    }
    news_[w] = 0;
  }
}

int Goals::distance(int w, int robot) const {
  if (!way(w, robot)) return 0;
  const int far = (*way(w, robot))[state_.cell[w][robot]];
  return far == kFar ? 0 : far;
}

bool Goals::isGone(int w, int robot) const {
  const int aim = aim_[w][robot], load = state_.load[w][robot];
  if (aim == kNone) return false;
  if (load == kNone) return state_.unit_cell[w][aim] == kNone || !state_.requested[w][aim];
  return !state_.requested[w][load] && state_.unit_at[w][aim] != kNone;
}

void Goals::find(int w, int robot) {
  const int load = state_.load[w][robot];
  if (load == kNone) {
    findUnit(w, robot);
  } else if (state_.requested[w][load]) {
    choose(w, robot, floor_.stations(), Deck::kAisles);
  } else {
    findPlace(w, robot);
  }
}

void Goals::findOpen(int w) {
  std::vector<char> unit_taken(state_.units()), place_taken(floor_.size());
  for (int robot = 0; robot < state_.robots(); ++robot) {
    const int aim = aim_[w][robot];
    if (aim != kNone) (state_.load[w][robot] == kNone ? unit_taken : place_taken)[aim] = 1;
  }
  open_units_.clear();
  open_unit_cells_.clear();
  for (int unit = 0; unit < state_.units(); ++unit) {
    const int cell = state_.unit_cell[w][unit];
    if (!state_.requested[w][unit] || cell == kNone || unit_taken[unit]) continue;
    open_units_.push_back(unit);
    open_unit_cells_.push_back(cell);
  }
  open_places_.clear();
  for (const int place : places_) {
    if (state_.unit_at[w][place] == kNone && !place_taken[place]) open_places_.push_back(place);
  }
}

void Goals::findUnit(int w, int robot) {
  const int chosen = choose(w, robot, open_unit_cells_, Deck::kUnder);
  if (chosen == kNone) return;
  aim_[w][robot] = open_units_[chosen];
  open_units_.erase(open_units_.begin() + chosen);
  open_unit_cells_.erase(open_unit_cells_.begin() + chosen);
}

void Goals::findPlace(int w, int robot) {
  const int chosen = choose(w, robot, open_places_, Deck::kAisles);
  if (chosen == kNone) return;
  aim_[w][robot] = open_places_[chosen];
  open_places_.erase(open_places_.begin() + chosen);
}

int Goals::choose(int w, int robot, const std::vector<int>& cells, Deck deck) {
  int chosen = kNone;
  const Way* shortest = nullptr;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const Way& way = ways_.to(cells[k], deck);
    const int at = state_.cell[w][robot];
    if (shortest && way[at] >= (*shortest)[at]) continue;
    shortest = &way;
    chosen = static_cast<int>(k);
  }
  if (!shortest) return kNone;
  cell_[w][robot] = cells[chosen];
  way_[w][robot] = shortest;
  return chosen;
}

}  // namespace learning
