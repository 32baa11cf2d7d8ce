// SPDX-License-Identifier: Apache-2.0
//
// The rules of the task: what robots may do, and what has come of it when physics has had its say.
#pragma once

#include <cstdint>
#include <vector>

#include "floor.h"
#include "goals.h"
#include "state.h"

namespace learning {

/// Numbered as in RWARE.
enum Action : std::int8_t { kWait, kForward, kLeft, kRight, kLift };
constexpr int kActions = 5;

/// What a robot is to begin. A lift is of `unit`: up if it carries none, down else.
struct Order {
  int warehouse, robot;
  Action action;
  int unit;
};

/// One robot of one warehouse.
struct Who {
  int warehouse, robot;
};

/// What happened to each robot.
struct Outcome {
  Outcome(int warehouses, int robots)
      : lifted(warehouses, robots), dropped(warehouses, robots), stored(warehouses, robots) {}

  Table<bool> lifted, dropped;  ///< A requested unit, undelivered.
  Table<bool> stored;           ///< A delivered unit was put back.
  std::vector<Who> arrived;     ///< They stand at a station with a load.
};

class Rules {
 public:
  /// reserve: forward is impossible where another robot stands or goes.
  Rules(const Floor& floor, State* state, Goals* goals, bool reserve);

  // Arrays: robots, warehouse after warehouse.

  /// Which actions each robot may choose now: kActions a robot.
  void possible(bool* out);
  /// Robots begin what they may. Tells who does as told.
  std::vector<Order> begin(const bool* possible, const std::int8_t* actions, bool* done);
  /// What came of it, by what robots carry now and carried then.
  Outcome settle();

 private:
  int ahead(int w, int robot) const;
  bool mayLift(int w, int robot) const;  ///< Or put down.
  bool isOpen(int w, int robot) const;
  int unitFor(int w, int robot) const;
  void markHeld(int w, bool mark);
  void takeCells(int w, const std::int8_t* actions, bool* done);
  void takeTurns(int w, const std::int8_t* actions, bool* done);
  bool begin(int w, int robot, Action action);
  void changeLoad(int w, int robot, Outcome* outcome);

  const Floor& floor_;
  State& state_;
  Goals& goals_;
  bool reserve_;
  Table<std::int32_t> load_before_;
  // By cell, of one warehouse at a time.
  std::vector<char> held_;          // a robot stands there or goes there
  std::vector<std::int32_t> rank_;  // who turns there, by the order in which they may
};

}  // namespace learning
