// SPDX-License-Identifier: Apache-2.0
//
// Execution without physics: robots of the test follow their releases, and report as the test
// demands.
#include "warehouse_fleet/execution.h"

#include <gtest/gtest.h>

#include <cmath>
#include <deque>
#include <map>
#include <random>
#include <set>

#include "warehouse_fleet/epibt.h"

namespace fleet {
namespace {

constexpr double kTick = 0.1, kSpeed = 1.5;  // [s], [m/s]: these robots reach it at once

/// One that follows paths as the engine does, cell after cell at one speed.
struct SimulatedRobot {
  double x = 0, y = 0, yaw = 0;
  std::uint32_t id = 0;
  std::vector<Cell> path;
  std::uint32_t released = 0;
  std::size_t reached = 1, left = 0;
  bool is_active = false, is_stopped = false;
};

struct Message {
  double arrival;
  int robot;
  std::uint32_t id, first, released;
  std::vector<Cell> cells;
};

class ExecutionTest : public testing::Test {
 protected:
  ExecutionTest() : ExecutionTest(9, 7) {}
  ExecutionTest(int width, int height) : floor_(described(width, height)), execution_(floor_, {}) {}

  static FloorDescription described(int width, int height) {
    FloorDescription floor;
    floor.width = width;
    floor.height = height;
    floor.passable.assign(width * height, 1);
    return floor;
  }

  Cell cell(int x, int y) const { return y * floor_.width() + x; }

  int add(int x, int y, int heading = 0) {
    SimulatedRobot robot;
    robot.x = x;
    robot.y = y;
    robot.yaw = heading * M_PI / 2;
    robots_.push_back(robot);
    reports_.emplace_back();
    reports_.back().is_controlled = true;
    return static_cast<int>(robots_.size()) - 1;
  }

  void observe() {
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      const SimulatedRobot& robot = robots_[i];
      Report& report = reports_[i];
      const double dx = robot.x - report.x, dy = robot.y - report.y;
      report.vx = now_ > 0 ? dx / kTick : 0;
      report.vy = now_ > 0 ? dy / kTick : 0;
      report.x = robot.x;
      report.y = robot.y;
      report.yaw = robot.yaw;
      report.status = robot.is_active ? RobotStatus::kBusy : RobotStatus::kIdle;
      report.state = !robot.is_active   ? RobotState::kIdle
                     : isWaiting(robot) ? RobotState::kWaiting
                                        : RobotState::kMovingX;
      report.path_id = robot.id;
      report.reached = static_cast<std::uint32_t>(robot.reached);
      report.left = static_cast<std::uint32_t>(robot.left);
    }
    execution_.update(now_, reports_);
  }

  /// Plans all robots along these ways, in which each begins where it is.
  void plan(const std::vector<std::vector<Action>>& actions) {
    const std::vector<Cell> none(robots_.size(), kNowhere);
    std::vector<Cell> goals(robots_.size(), cell(0, 0));
    execution_.fleet(goals, none, static_cast<int>(actions[0].size()));
    Plan plan;
    plan.horizon = static_cast<int>(actions[0].size());
    for (const auto& row : actions) {
      for (const Action action : row) plan.actions.push_back(action);
    }
    execution_.adopt(plan);
  }

  /// Returns releases as messages that arrive at once.
  std::vector<Message> release() {
    const Releases releases = execution_.release();
    std::vector<Message> messages;
    std::size_t begin = 0;
    for (std::size_t i = 0; i < releases.robot.size(); ++i) {
      Message message{
          now_, releases.robot[i], releases.path_id[i], releases.first[i], releases.released[i],
          {}};
      message.cells.assign(releases.cells.begin() + begin,
                           releases.cells.begin() + begin + releases.points[i]);
      begin += releases.points[i];
      messages.push_back(message);
    }
    return messages;
  }

  /// Delivers a message as the engine does; reports what the engine would refuse.
  void deliver(const Message& message) {
    SimulatedRobot& robot = robots_[message.robot];
    const bool is_change = robot.is_active && robot.id == message.id;
    const bool is_gap = message.first > (is_change ? robot.path.size() : 0);
    if (!is_change &&
        (robot.is_active || robot.id == message.id || is_gap || message.cells[0] != at(robot))) {
      execution_.refused(message.robot);
      return;
    }
    if (!is_change) {
      robot.path.clear();
      robot.reached = 1;
      robot.left = 0;
    }
    if (is_gap || message.released < robot.reached + (isBetween(robot) ? 1 : 0)) return;
    for (std::size_t i = 0; is_change && i < message.cells.size(); ++i) {
      const std::size_t point = message.first + i;
      const std::size_t kept = std::min(robot.released, message.released);
      if (point < kept && robot.path[point] != message.cells[i]) return;
    }
    if (!message.cells.empty()) robot.path.resize(message.first);
    robot.path.insert(robot.path.end(), message.cells.begin(), message.cells.end());
    robot.id = message.id;
    robot.released = message.released;
    robot.is_active = true;
  }

  static bool isWaiting(const SimulatedRobot& robot) { return robot.reached >= robot.released; }
  Cell at(const SimulatedRobot& robot) const {
    return cell(std::lround(robot.x), std::lround(robot.y));
  }
  bool isBetween(const SimulatedRobot& robot) const {
    return std::hypot(robot.x - std::round(robot.x), robot.y - std::round(robot.y)) > 1e-6;
  }

  void drive(SimulatedRobot& robot) {
    if (!robot.is_active || robot.is_stopped) return;
    double way = kSpeed * kTick;
    while (way > 1e-9 && robot.reached < robot.released) {
      const Cell next = robot.path[robot.reached];
      const double dx = floor_.x(next) - robot.x, dy = floor_.y(next) - robot.y;
      const double yaw = std::atan2(dy, dx);
      if (std::abs(std::remainder(yaw - robot.yaw, 2 * M_PI)) > 1e-6) {
        robot.yaw = yaw;  // takes the rest of this tick
        return;
      }
      const double step = std::min(way, std::hypot(dx, dy));
      robot.x += step * std::cos(yaw);
      robot.y += step * std::sin(yaw);
      way -= step;
      if (std::hypot(floor_.x(next) - robot.x, floor_.y(next) - robot.y) > 1e-6) break;
      robot.x = floor_.x(next);
      robot.y = floor_.y(next);
      robot.left = robot.reached++;
    }
    if (robot.reached == robot.path.size()) robot.is_active = false;
  }

  /// A tick in which all messages arrive.
  void tick() {
    observe();
    for (const Message& message : release()) deliver(message);
    for (SimulatedRobot& robot : robots_) drive(robot);
    now_ += kTick;
  }

  /// Has a robot's new path given up, as a copy of it was refused; returns the one still under way.
  Message giveUp(int robot) {
    plan({straight(3)});
    const Message late = release().front();
    execution_.refused(robot);
    for (int i = 0; i < 15; ++i) {
      now_ += kTick;
      observe();
    }
    return late;
  }

  /// Cells that a robot's body is above.
  std::set<Cell> beneath(const SimulatedRobot& robot) const {
    std::set<Cell> cells;
    for (const double dx : {-0.3, 0.3}) {
      for (const double dy : {-0.3, 0.3}) {
        cells.insert(cell(std::lround(robot.x + dx), std::lround(robot.y + dy)));
      }
    }
    return cells;
  }

  /// Expects that no robot stands where another does, or in a cell that another holds. Cells in
  /// messages under way are held as well.
  void expectSafe() {
    std::map<Cell, int> above;
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      const int robot = static_cast<int>(i);
      for (const Cell c : beneath(robots_[i])) {
        EXPECT_TRUE(above.emplace(c, robot).second)
            << "robots " << above[c] << " and " << i << " in " << floor_.name(c) << " at " << now_;
        EXPECT_EQ(execution_.holder(c), robot) << floor_.name(c) << " at " << now_;
      }
      for (std::size_t p = robots_[i].reached; p < robots_[i].released && robots_[i].is_active;
           ++p) {
        EXPECT_EQ(execution_.holder(robots_[i].path[p]), robot)
            << floor_.name(robots_[i].path[p]) << " at " << now_;
      }
    }
  }

  static std::vector<Action> straight(int cells, int waits = 0) {
    std::vector<Action> actions(waits, Action::kWait);
    actions.insert(actions.end(), cells, Action::kForward);
    actions.resize(8, Action::kWait);
    return actions;
  }

  Floor floor_;
  Execution execution_;
  std::vector<SimulatedRobot> robots_;
  std::vector<Report> reports_;
  double now_ = 0;
};

TEST_F(ExecutionTest, ACellIsNotPassedOnBeforeItWasLeft) {
  const int first = add(1, 1), second = add(0, 1);
  observe();
  plan({straight(4), straight(4, 1)});
  for (const Message& message : release()) deliver(message);
  robots_[first].is_stopped = true;
  for (int i = 0; i < 30; ++i) tick();
  EXPECT_EQ(at(robots_[second]), cell(0, 1));
  EXPECT_EQ(execution_.waitsFor(second), first);
  robots_[first].x = 2;  // its centre has come to the next cell, its load has not left the last
  robots_[first].reached = 2;
  tick();
  EXPECT_EQ(execution_.holder(cell(1, 1)), first);
  robots_[first].left = 1;
  tick();
  EXPECT_EQ(execution_.holder(cell(1, 1)), second);
  robots_[first].is_stopped = false;
  for (int i = 0; i < 60; ++i) {
    tick();
    observe();
    expectSafe();
  }
  EXPECT_GT(robots_[second].x, 0.9);
}

TEST_F(ExecutionTest, ACellIsPassedOnAsSoonAsItWasLeftThoughTheNextMiddleIsStillAhead) {
  const int first = add(1, 1), second = add(0, 1);
  observe();
  plan({straight(4), straight(4, 1)});
  for (const Message& message : release()) deliver(message);
  robots_[first].is_stopped = true;  // on the last centimetres, say
  robots_[first].x = 1.95;
  robots_[first].left = 1;
  tick();
  EXPECT_EQ(execution_.cellOf(first), cell(2, 1));
  EXPECT_EQ(execution_.holder(cell(1, 1)), second);
}

TEST_F(ExecutionTest, NobodyTurnsBesideALoadThatIsShortOfTheMiddleOfItsCell) {
  const int first = add(1, 1), second = add(0, 1);
  reports_[first].is_loaded = true;
  observe();
  std::vector<Action> around{Action::kWait, Action::kForward, Action::kTurnPositive,
                             Action::kForward};
  around.resize(8, Action::kWait);
  plan({straight(4), around});
  for (const Message& message : release()) deliver(message);
  robots_[first].is_stopped = true;
  robots_[first].x = 1.95;
  robots_[first].left = 1;
  for (int i = 0; i < 30; ++i) tick();
  EXPECT_EQ(execution_.released(second), std::vector<Cell>{cell(1, 1)});
  robots_[first].x = 2;
  robots_[first].reached = 2;
  tick();
  EXPECT_EQ(execution_.released(second).back(), cell(1, 2));
}

TEST_F(ExecutionTest, ALoadIsNotTurnedBesideOneThatStandsAskew) {
  const int askew = add(2, 3), driving = add(1, 2);
  robots_[askew].x = 2.3;
  robots_[askew].yaw = 0.3;
  reports_[askew].is_controlled = false;
  reports_[driving].is_loaded = true;
  observe();
  std::vector<Action> around{Action::kForward, Action::kTurnNegative, Action::kForward};
  around.resize(8, Action::kWait);
  plan({around});
  for (int i = 0; i < 30; ++i) tick();
  EXPECT_EQ(execution_.released(driving), std::vector<Cell>{cell(2, 2)});
  EXPECT_EQ(execution_.fleet({0, 0}, {-1, -1}, 8).tight, std::vector<Cell>{cell(2, 2)});
  robots_[askew].x = 2;
  robots_[askew].yaw = 0;
  tick();
  EXPECT_EQ(execution_.released(driving).back(), cell(2, 1));
}

TEST_F(ExecutionTest, OneThatHasBecomeBusySinceItsReportIsNotSentOn) {
  add(1, 1);
  observe();
  plan({straight(3)});
  execution_.setWork({1}, {0});
  EXPECT_TRUE(release().empty());
  execution_.setWork({0}, {0});
  EXPECT_FALSE(release().empty());
}

TEST_F(ExecutionTest, ATurnAndAWaitThatWerePlannedAreNoDelay) {
  const int robot = add(1, 1);
  observe();
  std::vector<Action> turn_and_wait(8, Action::kWait);
  turn_and_wait[0] = Action::kTurnPositive;
  plan({turn_and_wait});
  for (int i = 0; i < 10; ++i) tick();
  Journey waited = execution_.takeJourney(robot);
  EXPECT_GT(waited.planned, 0.8);
  EXPECT_NEAR(waited.planned, waited.driven, 1e-9);
  turn_and_wait[1] = Action::kForward;
  plan({turn_and_wait});
  for (int i = 0; i < 20; ++i) tick();
  const Journey driven = execution_.takeJourney(robot);
  EXPECT_NEAR(driven.planned, Motion{}.quarter + 2 * std::sqrt(1 / Motion{}.acceleration), 1e-9)
      << "the first turn is a part of it";
}

TEST_F(ExecutionTest, TheOrderOfThePlanIsKept) {
  // Both pass (3, 3); by the plan the later comes first, though the other stands nearer.
  const int near = add(2, 3, 0), far = add(3, 1, 1);
  observe();
  plan({straight(3, 4), straight(4)});
  int first = -1;
  for (int i = 0; i < 60 && first < 0; ++i) {
    tick();
    if (at(robots_[near]) == cell(3, 3)) first = near;
    if (at(robots_[far]) == cell(3, 3)) first = far;
  }
  EXPECT_EQ(first, far);
}

class Turning : public ExecutionTest, public testing::WithParamInterface<bool> {};

TEST_P(Turning, SideBySideExcludeEachOtherIfOneIsLoaded) {
  const int blocker = add(2, 2, 0);
  add(2, 3, 0);
  reports_[blocker].is_loaded = GetParam();
  observe();
  // Both turn, and leave away from each other.
  std::vector<Action> down{Action::kTurnNegative, Action::kForward},
      up{Action::kTurnPositive, Action::kForward};
  down.resize(8, Action::kWait);
  up.resize(8, Action::kWait);
  plan({down, up});
  observe();
  std::set<int> sent;
  for (const Message& message : release()) sent.insert(message.robot);
  EXPECT_EQ(sent.size(), GetParam() ? 1 : 2);
  EXPECT_TRUE(sent.count(blocker));
}

INSTANTIATE_TEST_SUITE_P(, Turning, testing::Bool());

TEST_F(ExecutionTest, ALostPathIsSentAgain) {
  add(1, 1);
  observe();
  plan({straight(3)});
  ASSERT_EQ(release().size(), 1u);  // lost
  std::size_t again = 0;
  for (int i = 0; i < 10 && again == 0; ++i) {
    now_ += kTick;
    observe();
    again = release().size();
  }
  EXPECT_EQ(again, 1u);
}

TEST_F(ExecutionTest, ARefusedPathIsGivenUpOnlyWhenNoCopyOfItIsOnItsWay) {
  const int robot = add(1, 1);
  observe();
  plan({straight(3)});
  const std::vector<Message> sent = release();
  ASSERT_EQ(sent.size(), 1u);
  const Cell ahead = cell(2, 1);
  ASSERT_EQ(execution_.holder(ahead), robot);
  execution_.refused(robot);  // a twin of it was
  now_ += kTick;
  observe();
  EXPECT_EQ(execution_.holder(ahead), robot);
  deliver(sent[0]);  // and this one is not
  for (int i = 0; i < 30; ++i) {
    observe();
    expectSafe();
    for (const Message& message : release()) deliver(message);
    drive(robots_[robot]);
    now_ += kTick;
  }
  EXPECT_EQ(at(robots_[robot]), cell(4, 1));
}

TEST_F(ExecutionTest, OneOnAPathThatWasGivenUpIsNotForeign) {
  const int robot = add(1, 1);
  observe();
  const Message late = giveUp(robot);
  plan({straight(3)});
  const Message next = release().front();
  ASSERT_NE(next.id, late.id);
  deliver(late);
  deliver(next);  // refused: it is busy
  observe();
  EXPECT_FALSE(execution_.isForeign(robot));
  EXPECT_TRUE(execution_.isOnDroppedPath(robot));

  robots_[robot].is_active = false;  // the caller has ended it
  for (int i = 0; i < 15; ++i) {
    now_ += kTick;
    observe();
    for (const Message& message : release()) deliver(message);
  }
  plan({straight(3)});
  for (int i = 0; i < 30; ++i) tick();
  EXPECT_EQ(at(robots_[robot]), cell(4, 1));

  robots_[robot].is_active = true;  // by others, who know this number from its first paths
  robots_[robot].id = late.id;
  observe();
  EXPECT_TRUE(execution_.isForeign(robot));
  EXPECT_FALSE(execution_.isOnDroppedPath(robot));
}

TEST_F(ExecutionTest, OneThatTakesItsPathAfterItWasGivenUpIsOnADroppedOne) {
  const int robot = add(1, 1);
  observe();
  const Message late = giveUp(robot);
  EXPECT_FALSE(execution_.isOnDroppedPath(robot));
  deliver(late);
  observe();
  EXPECT_FALSE(execution_.isForeign(robot));
  EXPECT_TRUE(execution_.isOnDroppedPath(robot));
}

TEST_F(ExecutionTest, OneThatIsBusyWhereItsReleasedPathEndsIsGivenTheEnd) {
  const int robot = add(1, 1);
  observe();
  plan({straight(6)});
  for (const Message& message : release()) deliver(message);
  while (!isWaiting(robots_[robot])) {
    now_ += kTick;
    drive(robots_[robot]);
    observe();
  }
  ASSERT_LT(robots_[robot].released, robots_[robot].path.size()) << "it waits for more";
  execution_.fleet({at(robots_[robot])}, {kNowhere}, 1);  // it is to stay there
  Plan stay;
  stay.horizon = 1;
  stay.actions = {Action::kWait};
  execution_.adopt(stay);
  reports_[robot].is_busy = true;  // as one in an elevator
  now_ += 1;
  observe();
  for (const Message& message : release()) deliver(message);
  now_ += kTick;
  drive(robots_[robot]);
  observe();
  EXPECT_TRUE(execution_.stands(robot));
}

TEST_F(ExecutionTest, ARefusedPathFreesItsCells) {
  const int robot = add(1, 1);
  observe();
  plan({straight(3)});
  release();
  execution_.refused(robot);
  for (int i = 0; i < 15; ++i) {
    now_ += kTick;
    observe();
  }
  EXPECT_EQ(execution_.holder(cell(1, 1)), robot);
  EXPECT_EQ(execution_.holder(cell(2, 1)), -1);
}

TEST_F(ExecutionTest, OneThatIsNotHeardKeepsWhatItMayHaveTaken) {
  const int robot = add(1, 1);
  observe();
  plan({straight(3)});
  release();
  execution_.setBroken({1});
  execution_.refused(robot);  // a twin of what it drives now, unheard
  for (int i = 0; i < 15; ++i) {
    now_ += kTick;
    observe();
  }
  EXPECT_EQ(execution_.holder(cell(2, 1)), robot);
  execution_.setBroken({0});
  observe();
  EXPECT_EQ(execution_.holder(cell(2, 1)), -1);
}

TEST_F(ExecutionTest, OneThatWasPushedHoldsBothCellsAndDrivesBackFirst) {
  const int robot = add(3, 3);
  observe();
  robots_[robot].x += 0.3;
  now_ += kTick;
  observe();
  EXPECT_TRUE(execution_.isAstray(robot));
  EXPECT_FALSE(execution_.stands(robot));
  EXPECT_EQ(execution_.holder(cell(3, 3)), robot);
  EXPECT_EQ(execution_.holder(cell(4, 3)), robot);
  const std::vector<Message> sent = release();
  ASSERT_EQ(sent.size(), 1u);
  EXPECT_EQ(sent[0].cells, std::vector<Cell>{cell(3, 3)});
  robots_[robot].x = 3;
  robots_[robot].id = sent[0].id;
  now_ += kTick;
  observe();
  EXPECT_TRUE(execution_.stands(robot));
  EXPECT_EQ(execution_.holder(cell(4, 3)), -1);
}

TEST_F(ExecutionTest, OneThatWasPushedKeepsItsRoomBetweenTwoAttempts) {
  const int robot = add(4, 3);
  observe();
  robots_[robot].x = 4.3;
  robots_[robot].yaw = 0.3;
  observe();
  ASSERT_EQ(release().size(), 1u);
  execution_.refused(robot);
  for (int i = 0; i < 30; ++i) {
    now_ += kTick;
    observe();
    EXPECT_EQ(execution_.holder(cell(5, 4)), robot) << now_;
    if (!release().empty()) execution_.refused(robot);
  }
  now_ += 30;
  observe();
  ASSERT_TRUE(execution_.isLost(robot));
  EXPECT_EQ(execution_.holder(cell(5, 4)), -1);
}

TEST_F(ExecutionTest, OneThatIsStillAskewAfterAnAttemptIsNotAskedAgainAtOnce) {
  const int robot = add(4, 3);
  observe();
  robots_[robot].yaw = 0.3;
  std::size_t sent = 0;
  for (int i = 0; i < 80; ++i) {
    now_ += kTick;
    observe();
    for (const Message& message : release()) {
      robots_[robot].id = message.id;  // it is there, it says, and its path is over
      ++sent;
    }
  }
  EXPECT_GE(sent, 2u);
  EXPECT_LE(sent, 5u);
}

/// Load and half of the room of one that passes in the middle of the next cell.
TEST_F(ExecutionTest, ALoadThatStandsAskewKeepsOthersFromItsCorners) {
  const int robot = add(4, 3);
  reports_[robot].is_loaded = true;
  reports_[robot].is_controlled = false;
  robots_[robot].yaw = M_PI / 4;
  observe();
  EXPECT_EQ(execution_.holder(cell(5, 3)), kNobody);  // there is room to pass it
  robots_[robot].x = 4.06;  // its corner is beyond the edge of a load in the next cell
  now_ += kTick;
  observe();
  now_ += kTick;
  observe();  // it stands
  EXPECT_EQ(execution_.holder(cell(5, 3)), robot);
  EXPECT_EQ(execution_.holder(cell(3, 3)), kNobody);
}

TEST_F(ExecutionTest, OneThatJumpsOffItsPathHoldsWhereItIs) {
  const int robot = add(1, 1), other = add(5, 5);
  observe();
  plan({straight(6), straight(0)});
  for (int i = 0; i < 8; ++i) tick();
  ASSERT_TRUE(robots_[robot].is_active);
  robots_[robot].x = 4.2;
  robots_[robot].y = 4;
  observe();
  EXPECT_EQ(execution_.holder(cell(4, 4)), robot);
  EXPECT_EQ(execution_.holder(cell(5, 4)), robot);
  EXPECT_EQ(execution_.holder(cell(5, 5)), other);
  robots_[robot].y = 3;
  observe();
  EXPECT_EQ(execution_.holder(cell(4, 4)), kNobody);
  EXPECT_EQ(execution_.holder(cell(4, 3)), robot);
}

/// A vehicle may report a place a second, and no speed.
TEST_F(ExecutionTest, OneThatIsSeenElsewhereAgainAndAgainMoves) {
  const int robot = add(1, 1);
  observe();
  plan({straight(7)});
  tick();
  ASSERT_TRUE(robots_[robot].is_active);
  observe();
  Report& report = reports_[robot];
  report.vx = 0;
  const auto tell = [&](double step) {
    now_ += kTick;
    report.x += step;
    execution_.update(now_, reports_);
  };
  for (int i = 0; i < 100; ++i) {
    tell(i % 10 == 0 ? 0.05 : 0);
    EXPECT_FALSE(execution_.isStalled(robot)) << now_;
  }
  for (int i = 0; i < 60; ++i) tell(0);
  EXPECT_TRUE(execution_.isStalled(robot));
}

/// The reports of a vehicle that tells its pose only as it comes to a cell's middle.
TEST_F(ExecutionTest, OneThatIsSeenOnlyInTheMiddleOfEachCellNeverStopsOnTheWay) {
  const int robot = add(0, 1);
  observe();
  plan({straight(8)});
  std::uint32_t shown = 0;
  for (int ticks = 0; robots_[robot].x < 8 && ticks < 200; ++ticks) {
    const SimulatedRobot& r = robots_[robot];
    Report& report = reports_[robot];
    const bool is_news = !r.is_active || shown != r.reached;
    const Report before = report;
    observe();
    if (!is_news) {
      report.x = before.x;
      report.y = before.y;
    }
    report.vx = r.is_active ? kSpeed : 0;
    shown = static_cast<std::uint32_t>(r.reached);
    execution_.update(now_, reports_);
    for (const Message& message : release()) deliver(message);
    const double x = r.x;
    drive(robots_[robot]);
    now_ += kTick;
    if (x > 0) EXPECT_GT(r.x, x) << now_;
  }
  EXPECT_EQ(robots_[robot].x, 8);
}

TEST_F(ExecutionTest, OneThatIsTakenAwayKeepsItsPathUntilThatIsOver) {
  const int robot = add(1, 1);
  observe();
  plan({straight(4)});
  for (int i = 0; i < 5; ++i) tick();
  reports_[robot].is_controlled = false;
  ASSERT_TRUE(robots_[robot].is_active);
  observe();
  expectSafe();
  const std::vector<Message> sent = release();
  EXPECT_TRUE(sent.empty());
}

/// A crowd over a line that delays half of all messages by up to 200 ms and loses a tenth, both
/// ways, while robots stop: planned by EPIBT, driven by Execution.
TEST_F(ExecutionTest, LateAndLostMessagesEndInNoContact) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> chance(0, 1);
  for (int y = 0; y < 6; y += 2) {
    for (int x = 0; x < 8; x += 2) add(x, y);
  }
  const auto planner = makeEpibt();
  planner->start(floor_, Rules{false, false}, 1);
  Plan plan;
  std::vector<Cell> goals, none(robots_.size(), kNowhere);
  for (std::size_t i = 0; i < robots_.size(); ++i)
    goals.push_back(cell(random() % 9, random() % 7));
  std::deque<Message> under_way;
  int arrivals = 0;
  double next_plan = 0;
  for (; now_ < 120; now_ += kTick) {
    if (chance(random) > 0.1) observe();
    for (std::size_t i = 0; i < robots_.size(); ++i) {
      if (!execution_.stands(i) || execution_.cellOf(i) != goals[i]) continue;
      goals[i] = cell(random() % 9, random() % 7);
      ++arrivals;
    }
    if (now_ >= next_plan) {
      next_plan = now_ + 2.0 / 3;
      planner->plan(execution_.fleet(goals, none, 7), {0, 0}, plan);
      execution_.adopt(plan);
    }
    for (Message message : release()) {
      if (chance(random) < 0.1) continue;
      if (chance(random) < 0.5) message.arrival += 0.2 * chance(random);
      under_way.push_back(message);
    }
    for (auto message = under_way.begin(); message != under_way.end();) {
      if (message->arrival > now_ + 1e-9) {
        ++message;
        continue;
      }
      deliver(*message);
      message = under_way.erase(message);
    }
    for (SimulatedRobot& robot : robots_) {
      if (chance(random) < 0.005) robot.is_stopped = !robot.is_stopped;
      if (chance(random) < 0.05) robot.is_stopped = false;
      drive(robot);
    }
    expectSafe();
    if (HasFailure()) return;
  }
  EXPECT_GT(arrivals, 100);
}

}  // namespace
}  // namespace fleet
