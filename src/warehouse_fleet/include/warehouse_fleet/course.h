// SPDX-License-Identifier: Apache-2.0
//
// A course: one robot's path, what the robot holds of it, and how far it has come.
#pragma once

#include <cstdint>
#include <deque>
#include <vector>

#include "warehouse_fleet/fleet.h"

namespace fleet {

/// Where a robot is with its path.
///
///   from                on                                      to
///   kObstacle           admit: it stands where it may           kStanding
///   kStanding           send: a path is released to it          kSent
///   kSent               refuse: the robot refuses the path      kRefused
///   kSent, kRefused     accept: the robot reports the path      kDriving
///   kDriving            withdraw: told to stop                  kWithdrawn
///   all but kObstacle   finish: its path is over                kStanding
///   all                 a new Course: it left the fleet         kObstacle
enum class Phase : std::uint8_t {
  kObstacle,   ///< Commanded by others, or pushed off the floor.
  kStanding,   ///< A member of the fleet without a path.
  kSent,       ///< The path was sent, and not reported yet.
  kRefused,    ///< The robot refused the path. It may still accept a duplicate of the release.
  kDriving,    ///< The robot has reported the path.
  kWithdrawn,  ///< Told to stop before an obstacle.
};

/// A robot's way to its goal as it was driven, to be compared with the plan.
struct Journey {
  double driven = 0;  ///< time since the robot left [s]
  double alone = 0;   ///< time that the same way takes a robot without others [s]
  /// `alone`, and waiting by the plan: by itself, or behind a robot that stood [s].
  double planned = 0;
  int cells = 0;
};

/// What keeps a robot from the next cell of its plan.
enum class Hindrance : std::uint8_t {
  kNone,    ///< nothing, or it has no plan
  kHolder,  ///< the robot ahead, which has not left the cell
  kOrder,   ///< a robot that passes the cell before it by the plan, and has not come yet
  kTurn,    ///< a robot beside it, while one of them turns
};

/// A cell that a plan passes, and the tick at which it is entered.
struct Step {
  Cell cell;
  int tick;
};

/// How a robot that was pushed comes back to the middle of a cell.
struct Recovery {
  double since = -1;          ///< [s]; -1: there is nothing to come back from
  double ended = -1e9;        ///< when an attempt ended that the robot had accepted [s]
  std::vector<Cell> refused;  ///< where it can't begin a path
};

struct Course {
  std::uint32_t id = 0;  ///< of the path; the last one if it is over
  int refusals = 0;      ///< of paths, one after the other
  double sent = 0;       ///< when a release was sent last [s]

  // The path: points 0 to released - 1; the cell where the robot stands if there is no path.
  std::vector<Cell> cells;
  int reached = 1, left = 0;
  bool is_short = false;    ///< stands short of the middle of the last cell that it reached
  Cell at = kNowhere;       ///< where it stands, or was last
  Cell turning = kNowhere;  ///< where it has been released around a corner

  // The plan beyond.
  std::deque<Step> plan;
  int committed = 0;           ///< cells ahead when the plan was requested
  std::vector<Cell> granted;   ///< cells released since then
  bool plan_is_stale = false;  ///< the robot has left the way that was planned for
  bool travels = false;        ///< has a goal elsewhere
  bool waits_by_plan = false;
  int waits_for = -1;  ///< a robot
  Hindrance hindrance = Hindrance::kNone;

  // Off the grid.
  bool is_astray = false;      ///< was pushed off the middle of its cell
  std::vector<Cell> occupied;  ///< cells beyond `cells` that it stands on: an obstacle, or astray
  Recovery recovery;

  double still_since = 0, blocked_since = -1;
  double moved = 0;  ///< when it moved last, or had nothing before it [s]
  Journey journey;
  int run = 0, run_heading = 0;  ///< cells driven straight on, and their heading

  Phase phase() const { return phase_; }
  bool isMember() const { return phase_ != Phase::kObstacle; }
  /// Whether a path is under way, or sent and not yet accepted.
  bool isActive() const { return phase_ > Phase::kStanding; }
  bool isAccepted() const { return phase_ >= Phase::kDriving; }
  bool isRefused() const { return phase_ == Phase::kRefused; }
  bool isWithdrawn() const { return phase_ == Phase::kWithdrawn; }
  int points() const { return static_cast<int>(cells.size()); }

  /// Makes the robot a member of the fleet, in a cell.
  void admit(Cell cell, double now, int heading);
  /// Notes that a path, or more of one, was sent.
  void send();
  /// Notes a refusal, unless the robot has reported the path.
  void refuse();
  /// Notes that the robot reports the path.
  void accept();
  /// Notes that the robot was told to stop; drops the plan beyond.
  void withdraw();
  /// Ends the path, in a cell.
  void finish(Cell cell);

 private:
  Phase phase_ = Phase::kObstacle;
};

}  // namespace fleet
