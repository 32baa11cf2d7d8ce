// SPDX-License-Identifier: Apache-2.0
//
// The rules of the task: the actions that robots may choose, and their outcome after physics.
#pragma once

#include <cstdint>
#include <vector>

#include "floor.h"
#include "goals.h"
#include "state.h"

namespace learning {

/// The actions, numbered as in RWARE.
enum Action : std::int8_t { kWait, kForward, kLeft, kRight, kLift };
constexpr int kActions = 5;

/// The order with which a robot begins an action. A lift concerns `unit`: up if the robot has no
/// load, else down.
struct Order {
  int warehouse, robot;
  Action action;
  int unit;
};

/// One robot of one warehouse.
struct Who {
  int warehouse, robot;
};

/// The outcome for each robot.
struct Outcome {
  Outcome(int warehouses, int robots)
      : lifted(warehouses, robots), dropped(warehouses, robots), stored(warehouses, robots) {}

  Table<bool> lifted, dropped;  ///< The unit is requested and undelivered.
  Table<bool> stored;           ///< A delivered unit was put back.
  std::vector<Who> arrived;     ///< Robots that stand at a station with a load.
};

class TaskRules {
 public:
  /// `reserve`: a robot can't go forward where another one stands or goes.
  TaskRules(const RimmedFloor& floor, TaskState* state, Goals* goals, bool reserve);

  // Arrays have an element a robot, warehouse by warehouse.

  /// Writes the actions that each robot may choose now: kActions a robot.
  void possible(bool* out);
  /// Begins the actions that are possible. `done`: whether each robot does its action.
  std::vector<Order> begin(const bool* possible, const std::int8_t* actions, bool* done);
  /// Returns the outcome, by the robots' loads now and then.
  Outcome settle();

 private:
  int ahead(int w, int robot) const;
  bool mayLift(int w, int robot) const;  ///< Lift or put down.
  bool isOpen(int w, int robot) const;
  int unitFor(int w, int robot) const;
  void markHeld(int w, bool mark);
  void takeCells(int w, const std::int8_t* actions, bool* done);
  void takeTurns(int w, const std::int8_t* actions, bool* done);
  bool begin(int w, int robot, Action action);
  void changeLoad(int w, int robot, Outcome* outcome);

  const RimmedFloor& floor_;
  TaskState& state_;
  Goals& goals_;
  bool reserve_;
  Table<std::int32_t> load_before_;
  // By cell, of one warehouse at a time.
  std::vector<char> held_;          // a robot stands there or goes there
  std::vector<std::int32_t> rank_;  // rank of the robot that turns there
};

}  // namespace learning
