// SPDX-License-Identifier: Apache-2.0
//
// Executes plans. The plan only gives the order in which robots pass each cell; robots may be early
// or late. The next cells of a robot are released as soon as they are free and it is that robot's
// turn. Execution arbitrates turning, so the planner may assume that every turn succeeds.
//
//   cell_holders.h   which robot holds which cell, and which cells are closed
//   course.h         one robot's path, a state machine
//   passing_order.h  which robot passes a cell next by the plan
//   src/core/execution/*.cpp  reports, plan, releases, recovery of robots that were pushed
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

/// The report of one robot. Names are those of FleetState.
struct Report {
  double x = 0, y = 0, yaw = 0;  ///< [m, rad]
  double vx = 0, vy = 0;         ///< [m/s]
  RobotStatus status = RobotStatus::kIdle;
  RobotState state = RobotState::kIdle;
  std::uint32_t path_id = 0, reached = 0, left = 0;
  bool is_controlled = false;  ///< false: an obstacle, since others command it or it is broken
  bool is_busy = false;        ///< busy with work other than driving; it is not sent on
  bool is_loaded = false;
};

/// Releases to send, with the fields of FleetFollow: `points` cells of each robot, robot by robot.
struct Releases {
  std::vector<int> robot;
  std::vector<std::uint32_t> path_id, first, points, released;
  std::vector<Cell> cells;
};

/// Drives a fleet by plans, cell by cell.
class Execution {
 public:
  Execution(const Floor& floor, const Motion& motion);

  /// Takes the reports of all robots at `time` [s], and frees the cells that robots have left. The
  /// first call, and one with another number of robots, starts from the reported positions.
  void update(double time, std::vector<Report> reports);

  /// Sets which robots are busy and loaded, one element a robot, if that changed since the reports.
  void setWork(const std::vector<std::uint8_t>& busy, const std::vector<std::uint8_t>& loaded);

  /// Sets which robots are broken, one element a robot: they stand or don't respond, and other
  /// robots take another way at once.
  void setBroken(std::vector<std::uint8_t> broken) { broken_ = std::move(broken); }

  /// Returns the fleet for the planner: positions of robots, and their committed actions. Robots
  /// that are not controlled are left out, and their cells are closed. `goal` and `home` have an
  /// element a robot, as in Fleet.
  Fleet fleet(const std::vector<Cell>& goal, const std::vector<Cell>& home, int horizon);
  int robots() const { return static_cast<int>(courses_.size()); }

  /// Makes robots drive by a plan for the last fleet() from now on. A robot that has been released
  /// other cells meanwhile keeps to them until the next plan.
  void adopt(const Plan& plan);

  /// Makes all robots drive whole plans from where they stand, one plan a robot; no other plan
  /// replaces them. Ticks ascend. Robots that follow each other in a ring at one tick would wait
  /// for each other.
  void drive(std::vector<std::deque<Step>> plans);

  /// Returns releases: for each robot the free cells that it needs in order not to brake.
  Releases release();

  /// Sets the aisle cells that units occupy: loaded robots can't pass.
  void setUnits(std::vector<Cell> cells) { holders_.setUnits(std::move(cells)); }
  /// Closes cells where people are or are about to be. A robot inside drives on along its released
  /// cells, and out.
  void setZone(std::vector<Cell> cells) { holders_.setZone(std::move(cells)); }
  /// Closes a zone: no robot enters it from outside, and those inside may leave. Robots that are
  /// about to enter stop before it, if they still can. Replaces the zone of the call before.
  void setClosedZone(std::vector<Cell> cells);
  /// Closes a cell until `until` [s].
  void close(Cell cell, double until) { holders_.close(cell, until); }
  /// Stops the robot that a cell was released to before that cell, if it can still stop, since an
  /// object lies there that robots don't see.
  void recall(Cell cell);
  /// Returns whether a cell is closed, by close() or because a robot met an obstacle there. The
  /// caller then checks whether the obstacle is still there.
  bool isClosing() const { return holders_.isClosing(now_); }
  /// Returns the cells closed now, including those of robots that are not controlled.
  std::vector<Cell> closed() const;

  /// Keeps a cell for a robot that others are to set down there, as an elevator does: no other
  /// robot is released into it. A robot keeps one cell at most, until it stands there or gives it
  /// up; its journey goes on there. Returns whether the cell was free.
  bool keep(int robot, Cell cell);
  /// Gives up the cell kept for a robot.
  void giveUp(int robot);

  // Queries about one robot; std::out_of_range for an unknown index.

  /// Returns its present or last cell; kNowhere beyond the floor.
  Cell cellOf(int robot) const { return courses_.at(robot).at; }
  /// Returns whether it stands in the middle of a cell with no further cell released.
  bool stands(int robot) const;
  /// Returns the robot that holds a cell, or kNobody.
  int holder(Cell cell) const { return holders_.holder(cell); }
  /// Returns the robot that a robot with a plan waits for, or kNobody.
  int waitsFor(int robot) const { return courses_.at(robot).waits_for; }
  /// Returns the cause that keeps a robot from the next cell of its plan.
  Hindrance hindrance(int robot) const { return courses_.at(robot).hindrance; }
  /// Returns the tick of the next step of its plan that is not released yet; -1 at the end.
  int nextTick(int robot) const;
  /// Returns the time since which a robot with a goal in another cell has stood [s]; for others the
  /// time of the last report.
  double stillSince(int robot) const { return courses_.at(robot).still_since; }
  /// Returns whether others command a robot: it is busy, but neither with its path nor with work
  /// that setWork() knows.
  bool isForeign(int robot) const;
  /// Returns whether a robot drives a path that was given up, since a copy of it came late. It gets
  /// no more of it: the caller has to end it.
  bool isOnDroppedPath(int robot) const;
  /// Returns whether a robot is broken, or stands although it may drive. The planner sees its cells
  /// as closed.
  bool isStalled(int robot) const;
  /// Returns whether a robot was pushed off the middle of its cell.
  bool isAstray(int robot) const { return courses_.at(robot).is_astray; }
  /// Returns whether a robot that was pushed can't come back to the grid; it gets no further
  /// attempts.
  bool isLost(int robot) const;
  /// Returns the cells that a robot holds ahead, and those planned beyond.
  std::vector<Cell> released(int robot) const;
  std::vector<Cell> planned(int robot) const;

  /// Notes that a robot refused its path. The path is dropped once none of its messages can still
  /// be on the way.
  void refused(int robot);

  /// Returns a robot's journey since the last call.
  Journey takeJourney(int robot);
  /// Returns the number of times that a robot was BLOCKED before a cell that it held.
  int blocked() const { return blocked_; }

 private:
  void updateMember(int robot, double elapsed, const Report& before);
  void updateOutsider(int robot);
  bool rests(int robot, const Report& before) const;
  void admit(int robot);
  void dismiss(int robot);
  void follow(int robot);
  void pass(int robot, int reached, int left);
  bool hasTurned(int robot) const;
  void finish(int robot);
  bool isOver(int robot) const;
  bool isDriving(int robot) const;
  void occupy(int robot);
  void renew(int robot);
  void keepAround(int robot);
  void cover(int robot);
  bool isOffItsPath(int robot) const;
  double reachOf(int robot) const;
  void vacate(int robot);
  void withdraw(int robot);
  void measure(int robot, double elapsed, const Report& before);
  void measureGap(int robot, const Report& before);
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
  void grant(int robot);
  void sendAgain(int robot);
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
  std::vector<Cell> tight_;  ///< sorted cells where a turned load would touch one askew
  std::vector<std::uint8_t> broken_;
  Fleet asked_;
  Releases releases_;  ///< to be sent
  int blocked_ = 0;
};

}  // namespace fleet
