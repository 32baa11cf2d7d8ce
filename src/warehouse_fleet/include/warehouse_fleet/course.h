// SPDX-License-Identifier: Apache-2.0
//
// A course: the path of one robot, the cells that it holds, and its progress.
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
///   kDriving            withdraw: commanded to stop             kWithdrawn
///   all but kObstacle   finish: its path is over                kStanding
///   all                 a new Course: it left the fleet         kObstacle
enum class CoursePhase : std::uint8_t {
  kObstacle,   ///< Commanded by others, or pushed off the floor.
  kStanding,   ///< A member of the fleet without a path.
  kSent,       ///< The path was sent, and not reported yet.
  kRefused,    ///< The robot refused the path. It may still accept a duplicate of the release.
  kDriving,    ///< The robot has reported the path.
  kWithdrawn,  ///< Commanded to stop before an obstacle.
};

/// The drive of a robot to its goal, for comparison with the plan.
struct Journey {
  double driven = 0;  ///< time since the robot left [s]
  double alone = 0;   ///< time of the same drive without other robots [s]
  /// Time of `alone`, and of waiting as planned: with a free way, or behind a standing robot [s].
  double planned = 0;
  int cells = 0;
};

/// The cause that keeps a robot from the next cell of its plan.
enum class Hindrance : std::uint8_t {
  kNone,    ///< nothing, or it has no plan
  kHolder,  ///< the robot ahead, which has not left the cell
  kOrder,   ///< a robot that precedes it by the plan and has not come yet
  kTurn,    ///< a robot beside it, while one of them turns
};

/// A cell of a plan, and the tick at which the robot enters it.
struct Step {
  Cell cell;
  int tick;
};

/// The recovery of a robot that was pushed off the middle of its cell.
struct Recovery {
  double since = -1;          ///< when it was pushed [s]; -1: nothing to recover from
  double ended = -1e9;        ///< when the last accepted attempt ended [s]
  std::vector<Cell> refused;  ///< cells where it can't begin a path
};

struct Course {
  std::uint32_t id = 0;      ///< id of the path, or of the last one
  std::uint32_t oldest = 0;  ///< id of the first path of which a copy may still be under way
  int refusals = 0;          ///< consecutive refusals of paths
  double sent = 0;           ///< time of the last release [s]

  // The path: points 0 to released - 1; the cell where the robot stands if there is no path.
  std::vector<Cell> cells;
  int reached = 1, left = 0;
  bool is_short = false;    ///< stands before the middle of the last cell that it reached
  Cell at = kNowhere;       ///< present or last cell
  Cell turning = kNowhere;  ///< cell of the corner that it has been released around

  // The plan beyond the released cells.
  std::deque<Step> plan;
  int committed = 0;           ///< cells ahead when the plan was requested
  std::vector<Cell> granted;   ///< cells released since then
  bool plan_is_stale = false;  ///< the robot has left the planned way
  bool travels = false;        ///< has a goal in another cell
  bool waits_by_plan = false;
  int waits_for = -1;  ///< index of a robot, or kNobody
  Hindrance hindrance = Hindrance::kNone;

  // The state of a robot off the grid.
  bool is_astray = false;  ///< was pushed off the middle of its cell
  std::vector<Cell>
      occupied;  ///< cells beyond `cells` that an obstacle or an astray robot stands on
  Recovery recovery;
  Cell kept = kNowhere;  ///< cell in which others are to set it down, which it holds already

  double still_since = 0, blocked_since = -1;
  double moved = 0;  ///< when it last moved or had nothing ahead [s]
  double posed = 0;  ///< when its pose was reported first [s]
  /// Time for which the reports repeat one pose while it moves: a robot that is elsewhere reports
  /// less often than the fleet's reports come [s].
  double pose_gap = 0;
  Journey journey;
  int run = 0, run_heading = 0;  ///< cells driven straight on, and their heading

  CoursePhase phase() const { return phase_; }
  bool isMember() const { return phase_ != CoursePhase::kObstacle; }
  /// Returns whether a path is under way, or sent and not yet accepted.
  bool isActive() const { return phase_ > CoursePhase::kStanding; }
  bool isAccepted() const { return phase_ >= CoursePhase::kDriving; }
  bool isRefused() const { return phase_ == CoursePhase::kRefused; }
  bool isWithdrawn() const { return phase_ == CoursePhase::kWithdrawn; }
  int points() const { return static_cast<int>(cells.size()); }
  /// Returns whether a path is one of this course that a robot may drive now: the last one, or one
  /// that was given up before it was accepted, whose copy came late.
  bool isOwn(std::uint32_t path) const { return path != 0 && oldest <= path && path <= id; }

  /// Makes the robot a member of the fleet, in a cell.
  void admit(Cell cell, double now, int heading);
  /// Notes that a path, or more of one, was sent.
  void send();
  /// Notes a refusal, unless the robot has reported the path.
  void refuse();
  /// Notes that the robot reports the path. Copies of those before have arrived: messages keep
  /// their order.
  void accept();
  /// Notes that the robot was commanded to stop; drops the plan beyond.
  void withdraw();
  /// Ends the path, in a cell.
  void finish(Cell cell);

 private:
  CoursePhase phase_ = CoursePhase::kObstacle;
};

}  // namespace fleet
