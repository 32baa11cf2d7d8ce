// SPDX-License-Identifier: Apache-2.0
#include "rules.h"

#include <algorithm>
#include <limits>

namespace learning {
namespace {

constexpr std::int32_t kNobody = std::numeric_limits<std::int32_t>::max();
constexpr std::int32_t kTurnsAlready = -1;  // rank before all robots that are about to turn

bool isTurn(std::int8_t action) { return action == kLeft || action == kRight; }

}  // namespace

TaskRules::TaskRules(const RimmedFloor& floor, TaskState* state, Goals* goals, bool reserve)
    : floor_(floor),
      state_(*state),
      goals_(*goals),
      reserve_(reserve),
      load_before_(state->warehouses(), state->robots(), kNone),
      held_(floor.size()),
      rank_(floor.size(), kNobody) {}

void TaskRules::possible(bool* out) {
  for (int w = 0; w < state_.warehouses(); ++w) {
    markHeld(w, reserve_);
    for (int robot = 0; robot < state_.robots(); ++robot, out += kActions) {
      const bool is_free = !state_.busy[w][robot];
      out[kWait] = true;
      out[kForward] = is_free && isOpen(w, robot);
      out[kLeft] = out[kRight] = is_free;
      out[kLift] = is_free && mayLift(w, robot);
    }
    markHeld(w, false);
  }
}

std::vector<Order> TaskRules::begin(const bool* possible, const std::int8_t* actions, bool* done) {
  const int robots = state_.robots();
  std::vector<Order> orders;
  for (int w = 0; w < state_.warehouses(); ++w, actions += robots, done += robots) {
    for (int robot = 0; robot < robots; ++robot, possible += kActions) {
      done[robot] = possible[actions[robot]];
    }
    takeTurns(w, actions, done);
    if (reserve_) takeCells(w, actions, done);
    for (int robot = 0; robot < robots; ++robot) {
      const Action action = done[robot] ? static_cast<Action>(actions[robot]) : kWait;
      if (begin(w, robot, action)) orders.push_back({w, robot, action, unitFor(w, robot)});
    }
  }
  return orders;
}

Outcome TaskRules::settle() {
  Outcome outcome(state_.warehouses(), state_.robots());
  for (int w = 0; w < state_.warehouses(); ++w) {
    for (int robot = 0; robot < state_.robots(); ++robot) {
      const int load = state_.load[w][robot];
      if (load != load_before_[w][robot]) changeLoad(w, robot, &outcome);
      const bool is_there = floor_.isStation(state_.cell[w][robot]);
      if (is_there && load != kNone && !state_.busy[w][robot])
        outcome.arrived.push_back({w, robot});
    }
  }
  return outcome;
}

int TaskRules::ahead(int w, int robot) const {
  return floor_.inside(state_.cell[w][robot] + floor_.step(state_.heading[w][robot]));
}

bool TaskRules::mayLift(int w, int robot) const {
  const int cell = state_.cell[w][robot];
  return state_.load[w][robot] == kNone ? state_.unit_at[w][cell] != kNone : floor_.isStorage(cell);
}

bool TaskRules::isOpen(int w, int robot) const {
  const int cell = ahead(w, robot);
  const bool fits = state_.load[w][robot] == kNone || state_.unit_at[w][cell] == kNone;
  return floor_.isPassable(cell) && !held_[cell] && fits;
}

int TaskRules::unitFor(int w, int robot) const {
  const int load = state_.load[w][robot];
  return load == kNone ? state_.unit_at[w][state_.cell[w][robot]] : load;
}

void TaskRules::markHeld(int w, bool mark) {
  for (int robot = 0; robot < state_.robots(); ++robot) {
    held_[state_.cell[w][robot]] = held_[state_.bound_for[w][robot]] = mark;
  }
}

/// Gives a cell that several robots go to to the first of them.
void TaskRules::takeCells(int w, const std::int8_t* actions, bool* done) {
  const auto wants = [&](int robot) { return done[robot] && actions[robot] == kForward; };
  std::vector<int> taken;
  for (int robot = 0; robot < state_.robots(); ++robot) {
    if (!wants(robot)) continue;
    const int cell = ahead(w, robot);
    done[robot] = !held_[cell];
    held_[cell] = true;
    taken.push_back(cell);
  }
  for (const int cell : taken) held_[cell] = false;
}

/// Decides turns. A turning robot sweeps beyond its cell, and two side by side would touch: only
/// the first may turn.
void TaskRules::takeTurns(int w, const std::int8_t* actions, bool* done) {
  const int robots = state_.robots();
  for (int robot = 0; robot < robots; ++robot) {
    const bool turns_already = state_.turning[w][robot] && state_.busy[w][robot];
    const bool turns = done[robot] && isTurn(actions[robot]);
    rank_[state_.cell[w][robot]] = turns_already ? kTurnsAlready : turns ? robot : kNobody;
  }
  for (int robot = 0; robot < robots; ++robot) {
    if (!done[robot] || !isTurn(actions[robot])) continue;
    for (int heading = 0; heading < 4; ++heading) {
      const int beside = floor_.inside(state_.cell[w][robot] + floor_.step(heading));
      if (rank_[beside] < robot) done[robot] = false;
    }
  }
  for (int robot = 0; robot < robots; ++robot) rank_[state_.cell[w][robot]] = kNobody;
}

/// Begins an action. Returns whether there is an order to post.
bool TaskRules::begin(int w, int robot, Action action) {
  const bool busy = state_.busy[w][robot];
  load_before_[w][robot] = state_.load[w][robot];
  if (action == kForward) {
    state_.bound_for[w][robot] = ahead(w, robot);
  } else if (!busy) {
    state_.bound_for[w][robot] = state_.cell[w][robot];
  }
  state_.turning[w][robot] = isTurn(action) || (state_.turning[w][robot] && busy);
  return action != kWait;
}

void TaskRules::changeLoad(int w, int robot, Outcome* outcome) {
  const int cell = state_.cell[w][robot], load = state_.load[w][robot];
  if (load != kNone) {
    state_.unit_cell[w][load] = state_.unit_at[w][cell] = kNone;
    outcome->lifted[w][robot] = state_.requested[w][load];
  } else {
    const int unit = load_before_[w][robot];
    state_.unit_cell[w][unit] = cell;
    state_.unit_at[w][cell] = unit;
    outcome->dropped[w][robot] = state_.requested[w][unit];
    outcome->stored[w][robot] = state_.served[w][unit];
    state_.served[w][unit] = false;
  }
  goals_.end(w, robot);
}

}  // namespace learning
