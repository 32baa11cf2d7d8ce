// SPDX-License-Identifier: Apache-2.0
//
// Commands and their answers: every command gets ACCEPTED or REFUSED, every accepted one ends with
// one DONE or BLOCKED.
#include <algorithm>
#include <random>

#include "warehouse.h"

namespace kiva::test {
namespace {

using Kind = Event::Kind;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinite = std::numeric_limits<double>::infinity();

/// A robot alone on 20 × 20 m.
class Commands : public ::testing::Test {
 protected:
  Commands() {
    w.spawn("kiva", "kiva1", 0, 0);
    w.forget();
  }

  /// Steps, and expects that the posted command is refused for that reason with nothing changed.
  void expectRefused(const std::string& reason) {
    const Status status = w.status(1);
    EXPECT_PRED2(contains, w.refusal(), reason);
    EXPECT_EQ(w.status(1), status);
  }

  Warehouse w{Floorplan{20}};
};

// --- answers

TEST_F(Commands, HaveNumbersThatTheirEventsName) {
  w.movx(1, 1);
  w.movx(7, 1);
  w.runUntilIdle(1);
  w.rot(1, kLeft);
  w.runUntilIdle(1);
  EXPECT_EQ(w.last(Kind::kRefused).command, 2u);
  std::vector<std::pair<Kind, std::uint32_t>> of_robot;
  for (const Event& event : w.events) {
    if (event.model == "kiva1") of_robot.push_back({event.kind, event.command});
  }
  EXPECT_EQ(of_robot,
            (std::vector<std::pair<Kind, std::uint32_t>>{
                {Kind::kAccepted, 1}, {Kind::kDone, 1}, {Kind::kAccepted, 3}, {Kind::kDone, 3}}));
}

TEST_F(Commands, GiveEveryEventAText) {
  w.spawn("storage_unit", "storage_unit1", 1, 0);
  w.spawn("wall", "wall", 5, 0);
  w.movx(1, 1);
  w.runUntilIdle(1);
  w.carry(1, 1);
  w.runUntilIdle(1);
  w.drop(1, 1);
  w.runUntilIdle(1);
  w.movx(1, 8);
  w.runUntilIdle(1);
  w.world.remove("wall");
  w.step();
  for (Kind kind : {Kind::kAccepted, Kind::kDone, Kind::kLifted, Kind::kDropped, Kind::kBlocked,
                    Kind::kSpawned, Kind::kDeleted}) {
    EXPECT_GE(w.count(kind), 1);
    EXPECT_FALSE(w.last(kind).text.empty()) << static_cast<int>(kind);
  }
}

TEST_F(Commands, TellHowTheyEndedUntilTheNextIsAccepted) {
  const auto end = [&] { return w.world.fleet().last_end[0]; };
  EXPECT_EQ(end(), 0);
  w.movx(1, 1);
  w.runUntilIdle(1);
  EXPECT_EQ(end(), static_cast<int>(Kind::kDone));
  w.movx(1, 0.3);  // refused
  w.step();
  EXPECT_EQ(end(), static_cast<int>(Kind::kDone));
  w.spawn("wall", "wall", 4, 0);
  w.movx(1, 8);
  w.step();
  EXPECT_EQ(end(), 0);
  w.runUntilIdle(1);
  EXPECT_EQ(end(), static_cast<int>(Kind::kBlocked));
}

// --- refusals

TEST_F(Commands, ForAnUnknownRobotAreRefusedByName) {
  for (int id : {0, -1, 7, kMaxKivaId, std::numeric_limits<int>::max()}) {
    w.movx(id, 1);
    w.rot(id, kLeft);
    w.carry(id, 1);
    EXPECT_PRED2(contains, w.refusal(), "there is no robot kiva" + std::to_string(id));
    EXPECT_EQ(w.last(Kind::kRefused).model, "kiva" + std::to_string(id));
  }
  EXPECT_EQ(w.count(Kind::kRefused), 15);
}

TEST_F(Commands, ForADeletedRobotAreRefused) {
  w.movx(1, 1);
  w.world.remove("kiva1");
  EXPECT_PRED2(contains, w.refusal(), "there is no robot kiva1");
}

TEST_F(Commands, WithoutAFiniteNumberAreRefused) {
  for (double bad : {kNan, kInfinite, -kInfinite}) {
    w.movx(1, bad);
    expectRefused("a finite number of metres was expected");
    w.movy(1, bad);
    expectRefused("a finite number of metres was expected");
    w.mov(1, bad, 0);
    expectRefused("a finite number of metres was expected");
    w.mov(1, 0, bad);
    expectRefused("a finite number of metres was expected");
  }
}

TEST_F(Commands, ForHalfACellAreRefused) {
  w.movx(1, 0.5);
  expectRefused("distance 0.5 m is not a whole number of 1 m cells");
  w.movy(1, -2.3);
  expectRefused("distance -2.3 m is not a whole number");
  w.mov(1, 1, 2.5);
  expectRefused("y = 2.5 m is off the grid of 1 m");
  w.mov(1, -0.01, 2);
  expectRefused("x = -0.01 m is off the grid");
}

TEST_F(Commands, BeyondTheFloorAreRefused) {
  for (double distance : {10.0, -10.0, 1e6, 1e300, -1e308}) {
    w.movx(1, distance);
    expectRefused("");
    w.movy(1, distance);
    expectRefused("");
    w.mov(1, distance, 0);
    expectRefused("");
    w.mov(1, 0, distance);
    expectRefused("");
  }
  w.movx(1, 10);
  expectRefused("goal (10, 0) is outside the floor, which spans x -10…10 m, y -10…10 m");
  EXPECT_EQ(w.count(Kind::kAccepted), 0);
}

TEST_F(Commands, ToTheRimOfTheFloorAreAccepted) {
  w.mov(1, 9, -9);
  EXPECT_EQ(w.refusal(), "");
  w.runUntilIdle(1);
  w.expectAt(1, 9, -9);
  w.movx(1, 1);
  expectRefused("outside the floor");
  w.movy(1, -1);
  expectRefused("outside the floor");
}

TEST_F(Commands, WithoutAFloorAreRefused) {
  w.world.remove("ground_plane");
  w.movx(1, 1);
  expectRefused("there is no floor");
}

TEST_F(Commands, WithAWrongDirectionAreRefused) {
  for (int direction : {0, 2, -2, 127}) {
    w.rot(1, direction);
    expectRefused("direction " + std::to_string(direction));
  }
}

TEST_F(Commands, WithAWrongLiftStatusAreRefused) {
  w.spawn("storage_unit", "storage_unit1", 0, 0);
  for (int status : {2, 255, -1}) {
    w.lift(1, status, 1);
    expectRefused("status " + std::to_string(status));
  }
}

TEST_F(Commands, ThatNeedAPluginTheRobotHasNotAreRefused) {
  w.spawnText(withoutPlugin(kivaText(), "rotation"), "kiva2", 3, 0);
  w.rot(2, kLeft);
  EXPECT_PRED2(contains, w.refusal(), "no rotation plugin");
  w.movy(2, 1);
  EXPECT_PRED2(contains, w.refusal(), "no rotation plugin");
  w.movx(2, 1);  // ahead: no turn
  EXPECT_EQ(w.refusal(), "");
  w.spawnText(withoutPlugin(kivaText(), "lift"), "kiva3", 6, 0);
  w.carry(3, 1);
  EXPECT_PRED2(contains, w.refusal(), "no lift plugin");
}

TEST_F(Commands, FromNumbersAMicrometreOffTheGridAreAccepted) {
  w.movx(1, 3 + 1e-6);
  EXPECT_EQ(w.refusal(), "");
  w.runUntilIdle(1);
  w.mov(1, 3 - 1e-6, 2 + 1e-6);
  EXPECT_EQ(w.refusal(), "");
  w.runUntilIdle(1);
  w.expectAt(1, 3, 2);
}

// --- while the robot is busy

class WhileBusy : public Commands {
 protected:
  /// Expects that every kind of command is refused now, with the name of the state.
  void expectAllRefused(const std::string& state) {
    const std::string reason = "it is not idle but " + state;
    w.mov(1, 3, 3);
    expectRefused(reason);
    w.movx(1, 1);
    expectRefused(reason);
    w.movy(1, 0);
    expectRefused(reason);
    w.rot(1, kLeft);
    expectRefused(reason);
    w.carry(1, 1);
    expectRefused(reason);
    w.drop(1, 1);
    expectRefused(reason);
  }
  /// Expects that the command under way ends undisturbed.
  void expectDoneAt(double x, double y) {
    w.runUntilIdle(1);
    w.expectAt(1, x, y);
    EXPECT_EQ(w.count(Kind::kAccepted), 1);
    EXPECT_EQ(w.count(Kind::kDone), 1);
    EXPECT_EQ(w.count(Kind::kRefused), 6);
  }
};

TEST_F(WhileBusy, MovingXAllAreRefused) {
  w.movx(1, 3);
  w.runUntilState(1, State::kMovingX);
  expectAllRefused("MOVING_X");
  expectDoneAt(3, 0);
}

TEST_F(WhileBusy, MovingYAllAreRefused) {
  w.movy(1, 3);
  w.runUntilState(1, State::kMovingY);
  expectAllRefused("MOVING_Y");
  expectDoneAt(0, 3);
}

TEST_F(WhileBusy, RotatingAllAreRefused) {
  w.movy(1, -1);
  w.runUntilState(1, State::kRotating);
  expectAllRefused("ROTATING");
  expectDoneAt(0, -1);
}

TEST_F(WhileBusy, LiftingAllAreRefused) {
  w.spawn("storage_unit", "storage_unit1", 0, 0);
  w.carry(1, 1);
  w.runUntilState(1, State::kLifting);
  expectAllRefused("LIFTING");
  expectDoneAt(0, 0);
  EXPECT_EQ(w.loadOf(1), 1);
}

TEST_F(WhileBusy, BlockedAllAreRefused) {
  w.spawn("wall", "wall1", 6, 0, kQuarter);
  w.movx(1, 8);
  w.runUntilState(1, State::kBlocked);
  expectAllRefused("BLOCKED");
  w.runUntilIdle(1);
  w.expectOnGrid(1);
  EXPECT_EQ(w.count(Kind::kBlocked), 1);
  EXPECT_EQ(w.count(Kind::kDone), 0);
}

TEST_F(Commands, OfTwoInAStepTheFirstIsExecuted) {
  w.movx(1, 2);
  w.movx(1, -2);
  w.step();
  EXPECT_EQ(w.count(Kind::kAccepted), 1);
  EXPECT_EQ(w.count(Kind::kRefused), 1);
  w.runUntilIdle(1);
  w.expectAt(1, 2, 0);
}

// --- every command is answered, every accepted one ends

TEST_F(Commands, AcceptedOnesSayWhatIsToBeDone) {
  w.spawn("storage_unit", "storage_unit1", 0, 0);
  w.carry(1, 1);
  w.runUntilIdle(1);
  EXPECT_EQ(w.last(Kind::kAccepted).text, "carry storage_unit1");
  EXPECT_EQ(w.last(Kind::kAccepted).other, "storage_unit1");
  w.mov(1, 1, -2);
  w.runUntilIdle(1);
  EXPECT_EQ(w.last(Kind::kAccepted).text, "go to (1, -2)");
  w.movy(1, 2);
  w.runUntilIdle(1);
  EXPECT_EQ(w.last(Kind::kAccepted).text, "go 2 m along y");
  w.rot(1, kRight);
  w.runUntilIdle(1);
  EXPECT_EQ(w.last(Kind::kAccepted).text, "turn clockwise");
}

TEST_F(Commands, TenThousandInOneStepAreEachAnswered) {
  for (int i = 0; i < 10000; ++i) w.movx(1, i % 3 - 1);
  w.step();
  EXPECT_EQ(w.count(Kind::kAccepted) + w.count(Kind::kRefused), 10000);
  w.runUntilIdle(1);
  EXPECT_EQ(w.count(Kind::kDone), w.count(Kind::kAccepted));
  w.expectOnGrid(1);
}

TEST_F(Commands, TenThousandInOneSecondAreEachAnswered) {
  int posted = 0;
  w.run(1, [&] {
    for (int i = 0; i < 10; ++i) w.rot(1, ++posted % 2 ? kLeft : kRight);
  });
  w.runUntilIdle(1);
  EXPECT_EQ(posted, 10000);
  EXPECT_EQ(w.count(Kind::kAccepted) + w.count(Kind::kRefused), posted);
  EXPECT_EQ(w.count(Kind::kDone), w.count(Kind::kAccepted));
  EXPECT_GE(w.count(Kind::kAccepted), 2);
}

/// Any command, sensible or not, to one of `robots` robots.
void postAnything(Warehouse& w, int robots, std::mt19937& random) {
  const int id = 1 + static_cast<int>(random() % robots);
  const auto cells = [&] { return static_cast<int>(random() % 13) - 6.0; };
  switch (random() % 6) {
    case 0:
      return w.mov(id, cells(), cells());
    case 1:
      return w.movx(id, cells());
    case 2:
      return w.movy(id, cells());
    case 3:
      return w.rot(id, static_cast<int>(random() % 3) - 1);
    default:
      return w.lift(id, random() % 2, 1 + static_cast<int>(random() % 4));
  }
}

TEST(CommandsToAFleet, EveryAcceptedOneEndsInOneDoneOrBlocked) {
  constexpr int kRobots = 6;
  Warehouse w("hall.sdf");
  for (int i = 1; i <= kRobots; ++i) w.spawn("kiva", "kiva" + std::to_string(i), 2 * i - 7, -4);
  for (int i = 1; i <= 4; ++i) w.spawn("storage_unit", "storage_unit" + std::to_string(i), i, i);
  std::mt19937 random(3);
  w.run(60, [&] {
    if (random() % 20 == 0) postAnything(w, kRobots, random);
  });
  const auto all_idle = [&] {
    return std::all_of(w.world.fleet().status.begin(), w.world.fleet().status.end(),
                       [](Status status) { return status == Status::kIdle; });
  };
  w.runUntil(all_idle);
  for (int id = 1; id <= kRobots; ++id) {
    EXPECT_EQ(disorder(w.kindsOf("kiva" + std::to_string(id))), "") << "kiva" << id;
  }
  EXPECT_GT(w.count(Kind::kDone), 20);
}

// --- the grid is the world's

TEST(Grid, OfHalfAMetre) {
  Warehouse w(Floorplan{20, 0.5});
  w.spawn("kiva", "kiva1", 0.5, 0);
  w.movx(1, 1.5);
  EXPECT_EQ(w.refusal(), "");
  w.runUntilIdle(1);
  w.expectAt(1, 2, 0);
  w.mov(1, -0.5, 2.5);
  w.runUntilIdle(1);
  w.expectAt(1, -0.5, 2.5);
  w.movx(1, 0.25);
  EXPECT_PRED2(contains, w.refusal(), "not a whole number of 0.5 m cells");
}

TEST(Grid, OfOneAndAHalfMetres) {
  Warehouse w(Floorplan{20, 1.5});
  w.spawn("kiva", "kiva1", 1.5, -3);
  w.movx(1, 1);
  EXPECT_PRED2(contains, w.refusal(), "not a whole number of 1.5 m cells");
  w.mov(1, 2, 0);
  EXPECT_PRED2(contains, w.refusal(), "x = 2 m is off the grid of 1.5 m");
  w.mov(1, -4.5, 6);
  w.runUntilIdle(1);
  w.expectAt(1, -4.5, 6);
  w.expectOnGrid(1);
}

TEST(Grid, WithoutAWorldPluginIsOfOneMetre) {
  WorldDescription empty;
  EXPECT_EQ(World(empty).gridSpacing(), 1.0);
}

TEST(Grid, IsOfOneMetreWhereItsSpacingIsNone) {
  for (const double spacing : {0, -1}) {
    Warehouse w(Floorplan{20, spacing});
    EXPECT_EQ(w.world.gridSpacing(), 1.0);
    EXPECT_EQ(w.world.takeWarnings().size(), 1u);
  }
}

}  // namespace
}  // namespace kiva::test
