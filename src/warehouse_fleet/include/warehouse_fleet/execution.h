// SPDX-License-Identifier: Apache-2.0
//
// Who may be where: every cell is held by one robot at the most, from before it may enter until it
// and its load have left. Robots drive as they can, early or late; a plan says in which order they
// pass each cell, and each is released its next cells as soon as they are free and its turn.
#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "warehouse_fleet/fleet.h"

namespace fleet {

/// How cells lie in the world, and what robots can do.
struct Motion {
  double origin_x = 0, origin_y = 0;  ///< the centre of cell 0 [m]
  double spacing = 1;                 ///< of cells [m]
  double speed = 1.5;                 ///< at most [m/s]
  double acceleration = 1;            ///< and deceleration [m/s²]
  double quarter = 0.625;             ///< time of a quarter turn [s]
  double latency = 0.25;  ///< from a report to what it leads to having reached the robot [s]

  double tick() const { return spacing / speed; }
};

/// What one robot reports. The names are those of FleetState.
struct Report {
  double x = 0, y = 0, yaw = 0;  ///< [m, rad]
  double vx = 0, vy = 0;         ///< [m/s]
  std::uint8_t status = 0, state = 0;
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

/// What was seen of a robot's way to its goal, to compare what was driven with what was planned.
struct Journey {
  double driven = 0;  ///< since it left [s]
  double alone = 0;   ///< what the same way takes a robot without others [s]
  /// That, and where the plan let it wait: by itself, or behind a robot that stood [s].
  double planned = 0;
  int cells = 0;
};

class Execution {
 public:
  Execution(const Floor& floor, const Motion& motion);

  /// Takes in what all robots report at `time` [s]; frees the cells that they have left. If their
  /// number changes, or at the first call, all is taken anew from where they are.
  void observe(double time, const std::vector<Report>& reports);

  /// Who is busy, and who is loaded, if that has changed since the reports. An element a robot.
  void setWork(const std::vector<std::uint8_t>& busy, const std::vector<std::uint8_t>& loaded);

  /// Which robots are broken, so that they stand or can't be reached: others are sent around them
  /// at once. An element a robot.
  void setBroken(std::vector<std::uint8_t> broken) { broken_ = std::move(broken); }

  /// What the planner is to see: where robots are, what they can no longer take back. Robots that
  /// are not controlled are no part of it: their cells are closed. `goal` and `home` by robot, as
  /// in Fleet.
  Fleet fleet(const std::vector<Cell>& goal, const std::vector<Cell>& home, int horizon);
  int robots() const { return static_cast<int>(courses_.size()); }

  /// From now on robots drive by this plan for the last fleet(). Where a robot was released
  /// something else meanwhile it stays with that until the next plan.
  void adopt(const Plan& plan);

  /// Releases to each robot what it needs in order not to brake, as far as it may have it.
  Releases release();

  /// Units stand in these cells of the aisles, where loaded robots can't pass.
  void setUnits(std::vector<Cell> cells) { units_ = std::move(cells); }
  /// Nobody may enter these cells, where people are or are about to be; who is inside goes on with
  /// what was released, and out.
  void setZone(std::vector<Cell> cells);
  /// Nobody may enter it until `until` [s].
  void close(Cell cell, double until);
  /// Something lies in a cell that robots don't see: who was released it stops before it, if it
  /// can.
  void recall(Cell cell);
  /// Whether a cell is closed by that, or because a robot found something in its way there: look
  /// whether it stands there still.
  bool isClosing() const;
  /// Cells closed now, those of robots that are not controlled among them.
  std::vector<Cell> closed() const;

  // Of one robot; std::out_of_range if there is none of that index.

  /// Where it stands, or stood last; kNowhere beyond the floor.
  Cell cellOf(int robot) const { return courses_.at(robot).at; }
  /// Whether it stands in the middle of a cell with nothing released beyond.
  bool stands(int robot) const;
  /// Who holds a cell; -1: nobody.
  int holder(Cell cell) const { return holder_[cell]; }
  /// Whom a robot with a plan waits for; -1: nobody.
  int waitsFor(int robot) const { return courses_.at(robot).waits_for; }
  /// Since when it has stood although it has somewhere to go [s]; time of the last report if not.
  double stillSince(int robot) const { return courses_.at(robot).still_since; }
  /// Whether somebody else commands it: it is busy with neither its path nor what it is known to
  /// do.
  bool isForeign(int robot) const;
  /// Whether it is broken, or does not drive although it may. The planner sees its cells closed.
  bool isStalled(int robot) const;
  /// Whether it was pushed off the middle of its cell.
  bool isAstray(int robot) const { return courses_.at(robot).is_astray; }
  /// Whether it does not find back from where it was pushed, and is not asked to any more.
  bool isLost(int robot) const;
  /// Cells that it holds ahead, and those planned beyond.
  std::vector<Cell> released(int robot) const;
  std::vector<Cell> planned(int robot) const;

  /// A robot has refused the path that it was sent. The path is given up when nothing of it can be
  /// on its way any more.
  void refused(int robot);

  /// Its journey since the last call.
  Journey takeJourney(int robot);
  /// How often a robot was BLOCKED before a cell of its own.
  int blocked() const { return blocked_; }

 private:
  struct Step {
    Cell cell;
    int tick;
  };
  /// How one that was pushed comes back to the middle of a cell.
  struct Recovery {
    double since = -1;          ///< [s]; -1: there is nothing to come back from
    std::vector<Cell> refused;  ///< where it can't begin a path
  };
  /// One robot's path and what it holds of it.
  struct Course {
    bool is_member = false;     ///< drives as it is told; or an obstacle
    std::uint32_t id = 0;       ///< of the path; the last one if it is over
    bool is_active = false;     ///< under way, or sent and not yet accepted
    bool is_accepted = false;   ///< the robot has reported it
    bool is_refused = false;    ///< once at least, and not reported since
    int refusals = 0;           ///< of paths, one after the other
    bool is_withdrawn = false;  ///< told to stop before an obstacle
    double sent = 0;            ///< when a release was sent last [s]
    std::vector<Cell> cells;    ///< points 0 to released - 1; where it stands if there is no path
    int reached = 1, left = 0;
    bool is_short = false;      ///< of the middle of the last of those that it reached
    std::vector<Step> plan;     ///< beyond those
    int committed = 0;          ///< cells that it had before it when the plan was asked for
    std::vector<Cell> granted;  ///< what it was released since then
    bool is_off = false;        ///< is not any more where the plan was asked for
    Cell at = kNowhere;         ///< where it stands, or was last
    Cell turning = kNowhere;    ///< where it has been released around a corner
    bool is_astray = false;     ///< was pushed, and is not in the middle of its cell
    Recovery recovery;
    std::vector<Cell> occupied;  ///< what it stands on beyond `cells`: an obstacle, or astray
    bool travels = false;        ///< has somewhere to go
    bool waits_by_plan = false;
    int waits_for = -1;
    double still_since = 0, blocked_since = -1;
    double moved = 0;  ///< when it moved last, or had nothing before it [s]
    Journey journey;
    int run = 0, run_heading = 0;  ///< cells that it has driven straight on, and where to
  };
  struct Claim {
    Cell cell;
    int tick, robot;
  };

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
  void queueUp();
  int firstClaimant(Cell cell);
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

  void hold(Cell cell, int robot) { holder_[cell] = robot; }
  void free(Cell cell, int robot);
  Cell cellAt(double x, double y) const;
  double xOf(Cell cell) const { return motion_.origin_x + floor_.x(cell) * motion_.spacing; }
  double yOf(Cell cell) const { return motion_.origin_y + floor_.y(cell) * motion_.spacing; }
  Heading headingOf(int robot) const;
  int headingTo(Cell from, Cell to) const;
  double speedOf(int robot) const;
  double toGo(int robot) const;
  bool isCentred(int robot, double within) const;
  bool isBack(int robot) const;
  bool isSquare(int robot) const;

  const Floor& floor_;
  const Motion motion_;
  double now_ = 0;
  std::vector<Report> reports_;
  std::vector<Course> courses_;
  std::vector<int> holder_;  ///< by cell
  std::vector<int> members_;
  std::vector<Claim> claims_;  ///< by cell and tick
  std::vector<int> next_claim_;
  std::vector<double> closed_until_;  ///< by cell [s]
  std::vector<Cell> units_;
  std::vector<Cell> tight_;  ///< where a load that is turned would touch one askew; sorted
  std::vector<std::uint8_t> broken_;
  std::vector<Cell> closing_;  ///< cells that are, or were
  std::vector<Cell> zone_;
  std::vector<std::uint8_t> is_in_zone_;  ///< by cell
  Fleet asked_;
  Releases releases_;  ///< to be sent
  int blocked_ = 0;
};

}  // namespace fleet
