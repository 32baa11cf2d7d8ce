// SPDX-License-Identifier: Apache-2.0
#include "goals.h"

#include <algorithm>

namespace learning {

Goals::Goals(const RimmedFloor& floor, const TaskState& state)
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
  for (const int cell : floor.stations()) stations_.push_back(choice(kNone, cell, Deck::kAisles));
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
    take(w, robot, &open_units_);
  } else if (!state_.requested[w][load]) {
    take(w, robot, &open_places_);
  } else if (const Choice* station = nearest(w, robot, stations_)) {
    cell_[w][robot] = station->cell;
    way_[w][robot] = station->way;
  }
}

void Goals::findOpen(int w) {
  std::vector<char> unit_taken(state_.units()), place_taken(floor_.size());
  for (int robot = 0; robot < state_.robots(); ++robot) {
    const int aim = aim_[w][robot];
    if (aim != kNone) (state_.load[w][robot] == kNone ? unit_taken : place_taken)[aim] = 1;
  }
  open_units_.clear();
  for (int unit = 0; unit < state_.units(); ++unit) {
    const int cell = state_.unit_cell[w][unit];
    if (!state_.requested[w][unit] || cell == kNone || unit_taken[unit]) continue;
    open_units_.push_back(choice(unit, cell, Deck::kUnder));
  }
  open_places_.clear();
  for (const int place : places_) {
    if (state_.unit_at[w][place] != kNone || place_taken[place]) continue;
    open_places_.push_back(choice(place, place, Deck::kAisles));
  }
}

const Goals::Choice* Goals::nearest(int w, int robot, const std::vector<Choice>& choices) const {
  const int at = state_.cell[w][robot];
  const auto less = [at](const Choice& a, const Choice& b) { return (*a.way)[at] < (*b.way)[at]; };
  const auto nearest = std::min_element(choices.begin(), choices.end(), less);
  return nearest == choices.end() ? nullptr : &*nearest;
}

void Goals::take(int w, int robot, std::vector<Choice>* open) {
  const Choice* chosen = nearest(w, robot, *open);
  if (!chosen) return;
  aim_[w][robot] = chosen->aim;
  cell_[w][robot] = chosen->cell;
  way_[w][robot] = chosen->way;
  open->erase(open->begin() + (chosen - open->data()));
}

}  // namespace learning
