// SPDX-License-Identifier: Apache-2.0
//
// Executes plans: robots drive as they can, early or late; a plan says in which order they pass
// each cell, and each robot is released its next cells as soon as they are free and it is its turn.
// Execution arbitrates turning; the planner may assume that every turn succeeds.
//
//   cell_holders.h   which robot holds which cell, and which cells are closed
//   course.h         one robot's path, a state machine
//   passing_order.h  which robot passes a cell next by the plan
//   src/core/execution*.cpp  reports, plan, releases, recovery of robots that were pushed
#pragma once

#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

#include "warehouse_fleet/cell_holders.h"
#include "warehouse_fleet/course.h"
#include "warehouse_fleet/fleet.h"
#include "warehouse_fleet/message_enums.h"
#include "warehouse_fleet/motion.h"
#include "warehouse_fleet/passing_order.h"

namespace fleet {

/// What one robot reports. The names are those of FleetState.
struct Report {
  double x = 0, y = 0, yaw = 0;  ///< [m, rad]
  double vx = 0, vy = 0;         ///< [m/s]
  RobotStatus status = RobotStatus::kIdle;
  RobotState state = RobotState::kIdle;
  std::uint32_t path_id = 0, reached = 0, left = 0;
  bool is_controlled = false;  ///< or drives by itself, is broken, …: an obstacle
  bool is_busy = false;        ///< with something else than driving: it is not sent on
  bool is_loaded = false;
};

/// Releases to send, in the order of FleetFollow: `points` cells for each robot, all in a row.
struct Releases {
  std::vector<int> robot;
  std::vector<std::uint32_t> path_id, first, points, released;
  std::vector<Cell> cells;
};

/// Drives a fleet by plans, cell by cell.
class Execution {
 public:
  Execution(const Floor& floor, const Motion& motion);

  /// Updates all robots by what they report at `time` [s]; frees the cells that they have left. If
  /// their number changes, or at the first call, all begins from where they are.
  void update(double time, const std::vector<Report>& reports);

  /// Sets which robots are busy and loaded, if that has changed since the reports. An element a
  /// robot.
  void setWork(const std::vector<std::uint8_t>& busy, const std::vector<std::uint8_t>& loaded);

  /// Sets which robots are broken, so that they stand or can't be reached: others are sent around
  /// them at once. An element a robot.
  void setBroken(std::vector<std::uint8_t> broken) { broken_ = std::move(broken); }

  /// Returns what the planner is to see: where robots are, what they can no longer take back.
  /// Robots that are not controlled are no part of it: their cells are closed. `goal` and `home` by
  /// robot, as in Fleet.
  Fleet fleet(const std::vector<Cell>& goal, const std::vector<Cell>& home, int horizon);
  int robots() const { return static_cast<int>(courses_.size()); }

  /// Has robots drive by this plan for the last fleet() from now on. Where a robot was released
  /// something else meanwhile it stays with that until the next plan.
  void adopt(const Plan& plan);

  /// Has all robots drive these steps from where they stand, an element a robot: a whole plan,
  /// which nothing replaces. Ticks ascend. Robots that follow each other in a ring at one tick
  /// would wait for each other.
  void drive(std::vector<std::deque<Step>> plans);

  /// Releases to each robot what it needs in order not to brake, as far as it may have it.
  Releases release();

  /// Sets the cells of the aisles in which units stand: loaded robots can't pass.
  void setUnits(std::vector<Cell> cells) { holders_.setUnits(std::move(cells)); }
  /// Closes these cells, where people are or are about to be. A robot inside goes on with what was
  /// released, and out.
  void setZone(std::vector<Cell> cells) { holders_.setZone(std::move(cells)); }
  /// Closes a cell until `until` [s].
  void close(Cell cell, double until) { holders_.close(cell, until); }
  /// Stops the robot that was released a cell before it, if it still can: something lies there that
  /// robots don't see.
  void recall(Cell cell);
  /// Returns whether a cell is closed by close(), or because a robot found an obstacle there: look
  /// whether it stands there still.
  bool isClosing() const { return holders_.isClosing(now_); }
  /// Returns the cells closed now, those of robots that are not controlled among them.
  std::vector<Cell> closed() const;

  // Of one robot; std::out_of_range if there is none of that index.

  /// Returns where it stands, or stood last; kNowhere beyond the floor.
  Cell cellOf(int robot) const { return courses_.at(robot).at; }
  /// Returns whether it stands in the middle of a cell with nothing released beyond.
  bool stands(int robot) const;
  /// Returns the robot that holds a cell; kNobody.
  int holder(Cell cell) const { return holders_.holder(cell); }
  /// Returns the robot that one with a plan waits for; kNobody.
  int waitsFor(int robot) const { return courses_.at(robot).waits_for; }
  /// Returns what keeps it from the next cell of its plan.
  Hindrance hindrance(int robot) const { return courses_.at(robot).hindrance; }
  /// Returns the tick of the next step of its plan that it was not released yet; -1 at the end.
  int nextTick(int robot) const;
  /// Returns since when it has stood although it has somewhere to go [s]; time of the last report
  /// if not.
  double stillSince(int robot) const { return courses_.at(robot).still_since; }
  /// Returns whether others command it: it is busy with neither its path nor what it is known to
  /// do.
  bool isForeign(int robot) const;
  /// Returns whether it is broken, or does not drive although it may. The planner sees its cells
  /// closed.
  bool isStalled(int robot) const;
  /// Returns whether it was pushed off the middle of its cell.
  bool isAstray(int robot) const { return courses_.at(robot).is_astray; }
  /// Returns whether it does not find back from where it was pushed, and is not asked to any more.
  bool isLost(int robot) const;
  /// Returns the cells that it holds ahead, and those planned beyond.
  std::vector<Cell> released(int robot) const;
  std::vector<Cell> planned(int robot) const;

  /// Notes that a robot has refused the path that it was sent. The path is given up when nothing of
  /// it can be on its way any more.
  void refused(int robot);

  /// Returns its journey since the last call.
  Journey takeJourney(int robot);
  /// Returns how often a robot was BLOCKED before a cell of its own.
  int blocked() const { return blocked_; }

 private:
  void admit(int robot);
  void dismiss(int robot);
  void follow(int robot);
  void pass(int robot, int reached, int left);
  bool hasTurned(int robot) const;
  void finish(int robot);
  bool isOver(int robot) const;
  void occupy(int robot);
  void renew(int robot);
  void keepAround(int robot);
  void cover(int robot);
  void vacate(int robot);
  void withdraw(int robot);
  void measure(int robot, double elapsed);
  bool waitsAsPlanned(int robot) const;
  void endRun(Course& course) const;

  bool isBroken(int robot) const {
    return robot < static_cast<int>(broken_.size()) && broken_[robot] != 0;
  }
  void commit(int robot, std::uint8_t* row, int horizon) const;
  void take(int robot, const Plan& plan, int index);
  bool mayHave(int robot, Cell cell);
  bool needs(int robot) const;
  bool mayTurn(int robot) const;
  bool keepsFromTurning(int robot, Cell in, Cell from) const;
  void findTight();
  bool isAskew(int robot) const;
  bool isInReach(int robot, Cell cell) const;
  void extend(int robot);
  void recentre(int robot);
  Cell refuge(int robot) const;
  bool mayRest(int robot, Cell cell) const;
  bool isAtEnd(int robot) const;
  void releaseUpTo(int robot, int points);
  void send(int robot, int first);

  Heading headingOf(int robot) const;
  double speedOf(int robot) const;
  double toGo(int robot) const;
  bool isCentred(int robot, double within) const;
  bool isBack(int robot) const;
  bool isSquare(int robot) const;

  const Floor& floor_;
  const Motion motion_;
  const GridFrame frame_;
  CellHolders holders_;
  PassingOrder order_;
  double now_ = 0;
  std::vector<Report> reports_;
  std::vector<Course> courses_;
  std::vector<int> members_;
  std::vector<Cell> tight_;  ///< where a load that is turned would touch one askew; sorted
  std::vector<std::uint8_t> broken_;
  Fleet asked_;
  Releases releases_;  ///< to be sent
  int blocked_ = 0;
};

}  // namespace fleet
