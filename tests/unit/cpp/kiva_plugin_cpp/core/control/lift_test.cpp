// SPDX-License-Identifier: Apache-2.0
//
// Storage units: taking up, carrying, putting down, refusals; and the fate of units, items and
// tower when a model is deleted meanwhile.
#include "warehouse.h"

namespace kiva::test {
namespace {

using Kind = Event::Kind;

/// A Kiva that takes up units a metre away, on a plate that reaches as far.
std::string graspingKiva() {
  return replaced(kivaText({{"proximity", "1.5"}}), "<radius>0.25<", "<radius>1.5<");
}

/// A robot at the origin, beneath a storage unit.
class Lift : public ::testing::Test {
 protected:
  Lift() {
    w.spawn("kiva", "kiva1", 0, 0);
    w.spawn("storage_unit", "storage_unit1", 0, 0);
    w.forget();
  }

  void carry() {
    w.carry(1, 1);
    w.runUntilIdle(1);
    ASSERT_EQ(w.loadOf(1), 1);
  }
  void drop() {
    w.drop(1, 1);
    w.runUntilIdle(1);
  }
  /// Until the unit hangs halfway.
  void carryHalfway() {
    w.carry(1, 1);
    w.runUntil([&] { return w.tower(1) > 0.05; }, 5);
    ASSERT_EQ(w.loadOf(1), 1);
    ASSERT_EQ(w.state(1), State::kLifting);
  }
  void expectOnFloor(double x, double y) {
    EXPECT_EQ(w.carrierOf(1), 0);
    EXPECT_NEAR(w.unitPose(1).X(), x, kMillimetre);
    EXPECT_NEAR(w.unitPose(1).Y(), y, kMillimetre);
    EXPECT_EQ(w.unitPose(1).Z(), 0);
  }
  void expectTowerComesDown() {
    w.run(3);
    EXPECT_EQ(w.tower(1), 0);
    EXPECT_EQ(w.status(1), Status::kIdle);
    EXPECT_EQ(w.robot(1).load_mass, 0);
  }

  Warehouse w;
};

// --- carrying

TEST_F(Lift, RaisesTheUnitFiveCentimetresAtLeast) {
  w.carry(1, 1);
  const double took = w.runUntilIdle(1);
  EXPECT_NEAR(took, 2.2, 0.02);
  EXPECT_GE(w.unitPose(1).Z(), 0.05);
  EXPECT_EQ(w.carrierOf(1), 1);
  EXPECT_EQ(w.loadOf(1), 1);
}

TEST_F(Lift, TheUnitRisesWithTheTowerWithoutAJump) {
  double before = 0;
  w.carry(1, 1);
  w.runUntilIdle(1, 5, [&] {
    const double z = w.unitPose(1).Z();
    EXPECT_GE(z, before - 1e-9);
    EXPECT_LT(z - before, 0.1 * w.world.stepSize());  // 0.09 m/s at the fastest
    before = z;
  });
}

TEST_F(Lift, ReportsLiftedAndDroppedBeforeDone) {
  carry();
  EXPECT_EQ(w.kindsOf("kiva1"), (std::vector<Kind>{Kind::kAccepted, Kind::kLifted, Kind::kDone}));
  EXPECT_EQ(w.last(Kind::kLifted).other, "storage_unit1");
  w.forget();
  drop();
  EXPECT_EQ(w.kindsOf("kiva1"), (std::vector<Kind>{Kind::kAccepted, Kind::kDropped, Kind::kDone}));
  EXPECT_EQ(w.last(Kind::kDropped).other, "storage_unit1");
}

TEST_F(Lift, TheStatusNamesTheUnitFromContactToContact) {
  carry();
  drop();
  std::vector<int> shelves;
  for (const StatusChange& change : w.changes) shelves.push_back(change.shelf_id);
  EXPECT_EQ(shelves, (std::vector<int>{0, 1, 1, 1, 0, 0}));
  EXPECT_EQ(w.statesOf(1), (std::vector<State>{State::kLifting, State::kLifting, State::kIdle,
                                               State::kLifting, State::kLifting, State::kIdle}));
}

TEST_F(Lift, CarriesAHundredMetresThroughTurnsWithoutShift) {
  const auto corner = [&] {  // the farthest from the centre, as the robot sees it
    const Pose unit = w.world.basePose(w.index(1)).Inverse() * w.unitPose(1);
    return (unit * Pose(0.4, 0.4, 1.8, 0, 0, 0)).Pos();
  };
  carry();
  const Vector3 before = corner();
  double shift = 0;
  for (int lap = 0; lap < 5; ++lap) {
    for (const auto& [x, y] : {std::pair{5, 0}, {5, 5}, {0, 5}, {0, 0}}) {
      w.mov(1, x, y);
      w.runUntilIdle(1, 60, [&] { shift = std::max(shift, (corner() - before).Length()); });
    }
  }
  EXPECT_LT(shift, kMillimetre);
  drop();
  expectOnFloor(0, 0);
}

TEST_F(Lift, TheUnitComesDownOnItsGridPointTurnedAsTheRobotIs) {
  carry();
  w.mov(1, 4, -3);
  w.runUntilIdle(1);
  drop();
  expectOnFloor(4, -3);
  EXPECT_NEAR(w.unitPose(1).Rot().Yaw(), -kQuarter, kHundredthDegree);
  EXPECT_EQ(w.tower(1), 0);
  w.movx(1, 3);  // and stays there
  w.runUntilIdle(1);
  expectOnFloor(4, -3);
}

TEST_F(Lift, AUnitALittleOffTheCentreIsCarriedAsItStands) {
  w.spawn("kiva", "kiva2", 10, 0);
  w.spawn("storage_unit", "storage_unit2", 10.04, -0.03);
  w.carry(2, 2);
  w.runUntilIdle(2);
  w.movx(2, 5);
  w.runUntilIdle(2);
  EXPECT_NEAR(w.unitPose(2).X(), 15.04, kMillimetre);
  EXPECT_NEAR(w.unitPose(2).Y(), -0.03, kMillimetre);
}

TEST_F(Lift, ARobotPushedALittleReturnsToItsGridPointBeforeItLifts) {
  w.world.setState("kiva1", {Pose(-0.06, 0, 0, 0, 0, 0), {}});
  carry();
  w.expectAt(1, 0, 0);
  EXPECT_NEAR(w.unitPose(1).X(), 0, kMillimetre);
}

TEST_F(Lift, ARobotPushedALittleReturnsToItsGridPointBeforeItDrops) {
  carry();
  w.world.setState("kiva1", {Pose(0.2, -0.1, 0, 0, 0, 0.1), {}});
  drop();
  expectOnFloor(0, 0);
  EXPECT_NEAR(w.unitPose(1).Rot().Yaw(), 0, kHundredthDegree);
}

TEST_F(Lift, WithoutLiftingTimeTheUnitIsUpAtOnce) {
  w.spawnText(kivaText({{"time", "0"}}), "kiva2", 5, 0);
  w.spawn("storage_unit", "storage_unit2", 5, 0);
  w.carry(2, 2);
  EXPECT_LT(w.runUntilIdle(2), 0.01);
  EXPECT_NEAR(w.unitPose(2).Z(), 0.07, kMillimetre);  // the stroke less the gap of 3 cm
  w.drop(2, 2);
  EXPECT_LT(w.runUntilIdle(2), 0.01);
  EXPECT_EQ(w.unitPose(2).Z(), 0);
  EXPECT_EQ(w.count(Kind::kDropped, "kiva2"), 1);
}

TEST_F(Lift, ItsMassAndThatOfItsItemsLoadTheRobot) {
  w.spawn("item", "item1", 0.2, 0.1, 0, 0.46);
  w.spawn("item", "item2", -0.2, 0.1, 0, 0.81);
  carry();
  EXPECT_DOUBLE_EQ(w.robot(1).load_mass, 63);
  EXPECT_NEAR(w.robot(1).load_inertia, 6.4 + 2 * 1.5 * (0.2 * 0.2 + 0.1 * 0.1), 1e-9);
  w.world.remove("item1");
  EXPECT_DOUBLE_EQ(w.robot(1).load_mass, 61.5);
  w.spawn("item", "item3", 0, 0, 0, 0.46 + w.unitPose(1).Z());
  EXPECT_DOUBLE_EQ(w.robot(1).load_mass, 63);
  drop();
  EXPECT_EQ(w.robot(1).load_mass, 0);
  EXPECT_EQ(w.robot(1).load_inertia, 0);
}

// --- refusals

TEST_F(Lift, RefusesAUnitThatIsTooFarAway) {
  w.world.setState("kiva1", {Pose(0.6, 0, 0, 0, 0, 0), {}});
  w.carry(1, 1);
  EXPECT_PRED2(contains, w.refusal(), "0.600 m away");
  w.spawn("storage_unit", "storage_unit2", 20, 0);
  w.carry(1, 2);
  EXPECT_PRED2(contains, w.refusal(), "m away");
}

TEST_F(Lift, RefusesASecondUnitAndTheSameOneTwice) {
  w.spawn("storage_unit", "storage_unit2", 5, 0);
  carry();
  w.carry(1, 1);
  EXPECT_PRED2(contains, w.refusal(), "it carries storage_unit1");
  w.carry(1, 2);
  EXPECT_PRED2(contains, w.refusal(), "it carries storage_unit1");
  EXPECT_EQ(w.loadOf(1), 1);
}

TEST_F(Lift, RefusesAUnitThatAnotherRobotCarries) {
  w.spawnText(kivaText({{"proximity", "2"}}), "kiva2", 1, 0);
  carry();
  w.carry(2, 1);
  EXPECT_PRED2(contains, w.refusal(), "storage_unit1 is carried by kiva1");
}

TEST_F(Lift, RefusesAUnitThatAnotherRobotIsAboutToTake) {
  w.spawnText(kivaText({{"proximity", "2"}}), "kiva2", 1, 0);
  w.carry(1, 1);
  w.step();
  ASSERT_EQ(w.loadOf(1), 0);
  w.carry(2, 1);
  EXPECT_PRED2(contains, w.refusal(), "storage_unit1 is carried by kiva1");
}

TEST_F(Lift, RefusesToDropWhatItDoesNotCarry) {
  w.spawn("storage_unit", "storage_unit2", 5, 0);
  w.drop(1, 1);
  EXPECT_PRED2(contains, w.refusal(), "it does not carry storage_unit1");
  carry();
  w.drop(1, 2);
  EXPECT_PRED2(contains, w.refusal(), "it does not carry storage_unit2");
  EXPECT_EQ(w.loadOf(1), 1);
}

TEST_F(Lift, RefusesAnUnknownUnit) {
  for (int shelf : {0, -1, 7}) {
    w.carry(1, shelf);
    EXPECT_PRED2(contains, w.refusal(), "there is no storage_unit" + std::to_string(shelf));
    if (shelf == 0) continue;  // whatever it carries
    w.drop(1, shelf);
    EXPECT_PRED2(contains, w.refusal(), "there is no storage_unit" + std::to_string(shelf));
  }
}

TEST_F(Lift, DropsWhateverItCarriesWhereNoUnitIsNamed) {
  w.drop(1, 0);
  EXPECT_PRED2(contains, w.refusal(), "it carries nothing");
  w.carry(1, 1);
  w.runUntilIdle(1);
  w.drop(1, 0);
  w.runUntilIdle(1);
  EXPECT_EQ(w.loadOf(1), 0);
  EXPECT_EQ(w.last(Event::Kind::kDropped).other, "storage_unit1");
}

TEST_F(Lift, RefusesWhatIsTooHeavyItemsIncluded) {
  w.spawnText(unitOfMass(449), "storage_unit2", 5, 0);
  w.spawn("kiva", "kiva2", 5, 0);
  w.spawn("item", "item1", 5, 0, 0, 0.46);
  w.carry(2, 2);
  EXPECT_PRED2(contains, w.refusal(), "storage_unit2 weighs 450.5 kg");
  w.world.remove("item1");
  w.carry(2, 2);
  EXPECT_EQ(w.refusal(), "");
}

TEST_F(Lift, RefusesAUnitThatWouldTipOff) {
  for (double off : {0.24, 0.26, 0.3, 0.4}) {
    SCOPED_TRACE("centre of mass off by " + number(off) + " m");
    w.world.remove("storage_unit1");
    w.spawnText(replaced(modelText("storage_unit"), "<pose>0 0 1.0 0 0 0</pose>",
                         "<pose>0 " + number(off) + " 1.0 0 0 0</pose>"),
                "storage_unit1", 0, 0);
    w.carry(1, 1);
    const std::string refusal = w.refusal();
    if (off < 0.25) {
      EXPECT_EQ(refusal, "");
      w.runUntilIdle(1);
      EXPECT_EQ(w.loadOf(1), 1);
      drop();
    } else {
      EXPECT_PRED2(contains, refusal,
                   "storage_unit1 would tip off: its centre of mass lies " + number(off - 0.25));
    }
  }
}

TEST_F(Lift, ALoadWhoseCentreIsPutBeyondThePlateTipsOff) {
  carry();
  w.movx(1, 5);
  w.run(1);
  Link link = w.world.description("storage_unit1")->links.front();
  link.inertial_pose_in_link.Pos().Y() = 0.3;
  ASSERT_TRUE(w.world.setLinkInertia("storage_unit1", link));
  w.runUntilIdle(1, 10);
  EXPECT_EQ(w.last(Kind::kTipped).model, "storage_unit1");
  EXPECT_EQ(w.last(Kind::kBlocked).text, "has lost its load");
  EXPECT_EQ(w.loadOf(1), 0);
  double lean = 0;  // [rad]
  w.run(3, [&] { lean = std::max(lean, std::acos(w.unitPose(1).Rot().ZAxis().Z())); });
  EXPECT_GT(lean, 0.02);  // until its legs meet the floor
}

TEST_F(Lift, RefusesAUnitThatTheTowerDoesNotReach) {
  w.spawnText(replaced(kivaText(), "<height>0.10</height>", "<height>0.02</height>"), "kiva2", 5,
              0);
  w.spawn("storage_unit", "storage_unit2", 5, 0);
  w.carry(2, 2);
  EXPECT_PRED2(contains, w.refusal(), "does not reach storage_unit2");
}

TEST_F(Lift, RefusesWithoutALiftPlugin) {
  w.spawnText(withoutPlugin(kivaText(), "lift"), "kiva2", 5, 0);
  w.spawn("storage_unit", "storage_unit2", 5, 0);
  w.carry(2, 2);
  EXPECT_PRED2(contains, w.refusal(), "no lift plugin");
}

// --- two robots, one unit

TEST_F(Lift, OfTwoRobotsThatAskInTheSameStepOneGetsTheUnit) {
  w.spawnText(graspingKiva(), "kiva2", 20, 0);
  w.spawnText(graspingKiva(), "kiva3", 21, 0);
  w.spawn("storage_unit", "storage_unit2", 20.5, 0);
  w.carry(2, 2);
  w.carry(3, 2);
  w.step();
  EXPECT_EQ(w.count(Kind::kAccepted, "kiva2"), 1);
  EXPECT_EQ(w.count(Kind::kRefused, "kiva3"), 1);
  w.runUntilIdle(2);
  EXPECT_EQ(w.carrierOf(2), 2);
  EXPECT_EQ(w.loadOf(3), 0);
  EXPECT_EQ(w.tower(3), 0);
}

TEST_F(Lift, AUnitWhoseTakerIsGoneCanBeTakenByAnother) {
  w.spawnText(graspingKiva(), "kiva2", 1, 0);
  w.carry(1, 1);
  w.step();
  ASSERT_EQ(w.loadOf(1), 0);
  w.world.remove("kiva1");
  w.carry(2, 1);
  EXPECT_EQ(w.refusal(), "");
}

// --- a model goes

TEST_F(Lift, DeletingARobotThatCarriesPutsTheUnitDown) {
  w.spawn("item", "item1", 0.1, 0, 0, 0.46);
  carry();
  w.movx(1, 3);
  w.runUntilIdle(1);
  w.world.remove("kiva1");
  expectOnFloor(3, 0);
  EXPECT_NEAR(w.itemPose("item1").Z(), 0.46, 1e-9);
  w.run(0.1);
  w.spawn("kiva", "kiva2", 3, 0);
  w.carry(2, 1);
  w.runUntilIdle(2);
  EXPECT_EQ(w.carrierOf(1), 2);
}

TEST_F(Lift, DeletingARobotOnItsWayPutsTheUnitDownWhereItIs) {
  carry();
  w.movx(1, 5);
  w.run(3);
  const double x = w.x(1);
  ASSERT_GT(x, 0.5);
  ASSERT_LT(x, 4.5);
  w.world.remove("kiva1");
  expectOnFloor(x, 0);
  w.run(0.5);
  expectOnFloor(x, 0);
}

TEST_F(Lift, DeletingARobotWhileItLiftsPutsTheUnitDown) {
  carryHalfway();
  w.world.remove("kiva1");
  expectOnFloor(0, 0);
  w.run(0.5);
  expectOnFloor(0, 0);
}

TEST_F(Lift, DeletingACarriedUnitLowersTheTower) {
  carry();
  w.run(1);  // long enough to fall asleep
  w.forget();
  w.world.remove("storage_unit1");
  EXPECT_EQ(w.loadOf(1), 0);
  expectTowerComesDown();
  ASSERT_FALSE(w.statesOf(1).empty()) << "the status still names the unit that is gone";
  EXPECT_EQ(w.changes.back().shelf_id, 0);
  EXPECT_EQ(w.robot(1).load_half_length, 0);
  EXPECT_EQ(w.robot(1).load_half_width, 0);
}

TEST_F(Lift, DeletingAUnitThatIsBeingLiftedEndsTheCommandInBlocked) {
  carryHalfway();
  w.world.remove("storage_unit1");
  w.runUntilIdle(1);
  EXPECT_EQ(w.count(Kind::kBlocked, "kiva1"), 1);
  EXPECT_EQ(w.count(Kind::kLifted), 0);
  EXPECT_EQ(w.count(Kind::kDone), 0);
  expectTowerComesDown();
}

TEST_F(Lift, DeletingAUnitThatIsBeingLoweredEndsTheCommandInBlocked) {
  carry();
  w.drop(1, 1);
  w.run(1);
  ASSERT_EQ(w.loadOf(1), 1);
  w.world.remove("storage_unit1");
  w.runUntilIdle(1);
  EXPECT_EQ(w.count(Kind::kBlocked, "kiva1"), 1);
  EXPECT_EQ(w.count(Kind::kDropped), 0);
  expectTowerComesDown();
}

/// While kiva1 and storage_unit1 are deleted, the last robot and the last unit take their places.
class LiftOfTheLast : public Lift {
 protected:
  LiftOfTheLast() {
    w.spawn("kiva", "kiva2", 5, 0);
    w.spawn("storage_unit", "storage_unit2", 5, 0);
    w.spawn("item", "item2", 5, 0, 0, 0.46);
    w.carry(2, 2);
  }

  void deleteTheFirst() {
    w.world.remove("storage_unit1");
    w.world.remove("kiva1");
  }
  void expectCarriesAndDrops() {
    w.runUntilIdle(2);
    EXPECT_EQ(w.carrierOf(2), 2);
    EXPECT_EQ(w.loadOf(2), 2);
    w.movx(2, 2);
    w.runUntilIdle(2);
    EXPECT_NEAR(w.unitPose(2).X(), 7, kMillimetre);
    EXPECT_NEAR(w.itemPose("item2").X(), 7, kMillimetre);
    w.drop(2, 2);
    w.runUntilIdle(2);
    EXPECT_EQ(w.count(Kind::kDone, "kiva2"), 3);
    EXPECT_EQ(w.unitPose(2).Z(), 0);
    EXPECT_EQ(w.robot(2).load_mass, 0);
  }
};

TEST_F(LiftOfTheLast, GoesOnWhenTheFirstAreDeletedBeforeItMeetsTheUnit) {
  w.run(0.5);
  ASSERT_EQ(w.loadOf(2), 0);
  deleteTheFirst();
  w.spawnText(kivaText({{"proximity", "2"}}), "kiva3", 6, 0);
  w.carry(3, 2);
  EXPECT_PRED2(contains, w.refusal(), "storage_unit2 is carried by kiva2");
  w.world.remove("kiva3");
  expectCarriesAndDrops();
}

TEST_F(LiftOfTheLast, GoesOnWhenTheFirstAreDeletedWhileItRises) {
  w.run(1.5);
  ASSERT_EQ(w.loadOf(2), 2);
  deleteTheFirst();
  expectCarriesAndDrops();
}

TEST_F(LiftOfTheLast, GoesOnWhenTheFirstAreDeletedAfterwards) {
  w.runUntilIdle(2);
  deleteTheFirst();
  w.step();
  expectCarriesAndDrops();
}

// --- a hand comes in between

TEST_F(Lift, AUnitMovedAwayBeforeTheTowerMeetsItIsNotTaken) {
  w.carry(1, 1);
  w.run(0.1);
  ASSERT_EQ(w.loadOf(1), 0);
  w.world.setState("storage_unit1", {Pose(5, 5, 0, 0, 0, 0), {}});
  w.runUntilIdle(1);
  EXPECT_EQ(w.count(Kind::kBlocked, "kiva1"), 1);
  EXPECT_EQ(w.count(Kind::kLifted), 0);
  EXPECT_NEAR(w.unitPose(1).X(), 5, kMillimetre);
  expectTowerComesDown();
}

TEST_F(Lift, AUnitTakenOffTheTowerLeavesTheRobotEmpty) {
  carry();
  w.run(1);
  w.world.setState("storage_unit1", {Pose(5, 5, 0, 0, 0, 0), {}});
  EXPECT_EQ(w.loadOf(1), 0);
  expectTowerComesDown();
  EXPECT_NEAR(w.unitPose(1).X(), 5, kMillimetre);
}

TEST_F(Lift, AUnitTakenOffWhileItIsLiftedIsNotTakenAgain) {
  carryHalfway();
  w.world.setState("storage_unit1", {Pose(5, 5, 0, 0, 0, 0), {}});
  w.runUntilIdle(1);
  EXPECT_EQ(w.count(Kind::kBlocked, "kiva1"), 1);
  EXPECT_EQ(w.count(Kind::kLifted), 0);
  EXPECT_EQ(w.carrierOf(1), 0);
  expectTowerComesDown();
}

TEST_F(Lift, AUnitTakenOffWhileItIsLoweredEndsTheCommandInBlocked) {
  carry();
  w.drop(1, 1);
  w.run(0.5);
  w.world.setState("storage_unit1", {Pose(5, 5, 0, 0, 0, 0), {}});
  w.runUntilIdle(1);
  EXPECT_EQ(w.count(Kind::kBlocked, "kiva1"), 1);
  EXPECT_EQ(w.count(Kind::kDropped), 0);
  expectTowerComesDown();
}

TEST_F(Lift, ARobotMovedByHandTakesItsUnitAlong) {
  carry();
  w.world.setState("kiva1", {Pose(7, 7, 0, 0, 0, 0), {}});
  w.run(0.1);
  EXPECT_EQ(w.loadOf(1), 1);
  EXPECT_NEAR(w.unitPose(1).X(), 7, kMillimetre);
  EXPECT_NEAR(w.unitPose(1).Z(), 0.07, kMillimetre);
  drop();
  expectOnFloor(7, 7);
}

TEST_F(Lift, ARobotMovedByHandWhileItLiftsCanStillDrop) {
  carryHalfway();
  w.world.setState("kiva1", {Pose(7, 7, 0, 0, 0, 0), {}});
  EXPECT_EQ(w.status(1), Status::kIdle);
  drop();
  expectOnFloor(7, 7);
  EXPECT_EQ(w.tower(1), 0);
}

// --- items

TEST_F(Lift, ItemsGoWithTheirUnitAndKeepTheirPlace) {
  w.spawn("item", "item1", 0.2, 0.1, 0, 0.46);
  ASSERT_EQ(w.world.items().at(0).unit, 0);
  carry();
  EXPECT_NEAR(w.itemPose("item1").Z(), 0.46 + w.unitPose(1).Z(), 1e-9);
  w.mov(1, 3, 4);  // ends turned to the left: the item's x offset is along y now
  w.runUntilIdle(1);
  EXPECT_NEAR(w.itemPose("item1").X(), 3 - 0.1, kMillimetre);
  EXPECT_NEAR(w.itemPose("item1").Y(), 4 + 0.2, kMillimetre);
  drop();
  EXPECT_NEAR(w.itemPose("item1").Z(), 0.46, 1e-9);
}

TEST_F(Lift, ItemsOfADeletedUnitGoToo) {
  w.spawn("item", "item1", 0.2, 0.1, 0, 0.46);
  w.spawn("item", "item2", -0.2, 0.1, 0, 0.46);
  w.spawn("storage_unit", "storage_unit2", 5, 0);
  w.spawn("item", "item3", 5, 0, 0, 0.46);
  w.world.remove("storage_unit1");
  EXPECT_FALSE(w.world.has("item1"));
  EXPECT_FALSE(w.world.has("item2"));
  ASSERT_TRUE(w.world.has("item3"));
  EXPECT_NEAR(w.itemPose("item3").X(), 5, 1e-9);
  ASSERT_EQ(w.world.items().size(), 1u);
  EXPECT_EQ(w.world.storageUnits().at(w.world.items()[0].unit).id, 2);
}

TEST_F(Lift, AnItemWhereNoUnitIsFallsToTheFloor) {
  w.spawn("item", "item1", 3, 0, 0, 1);
  EXPECT_EQ(w.world.items().at(0).unit, -1);
  w.run(2);
  EXPECT_NEAR(w.itemPose("item1").Z(), 0, kMillimetre);
  EXPECT_NEAR(w.itemPose("item1").X(), 3, kMillimetre);
}

// --- force

/// A slab of 2 x 2 m whose underside is that high, on four legs that keep clear of robots.
std::string ceiling(double height) {
  return "<sdf version='1.9'><model name='m'><static>true</static><link name='l'><pose>0 0 " +
         number(height + 0.1) +
         " 0 0 0</pose><collision name='c'><geometry><box><size>2 2 0.2</size></box></geometry>"
         "</collision></link></model></sdf>";
}

TEST_F(Lift, StallsBeneathACeilingPutsDownAndTellsWhy) {
  constexpr double kTop = 1.80, kRoom = 0.06;  // of the unit, and above it [m]
  w.spawnText(ceiling(kTop + kRoom), "ceiling", 0, 0);
  w.carry(1, 1);
  double highest = 0;
  w.runUntilIdle(1, 20, [&] { highest = std::max(highest, w.unitPose(1).Z()); });
  EXPECT_NEAR(highest, kRoom, 1e-6);
  EXPECT_EQ(w.count(Event::Kind::kLifted), 0);
  EXPECT_EQ(w.count(Event::Kind::kDropped), 1);
  const Event blocked = w.last(Event::Kind::kBlocked);
  EXPECT_EQ(blocked.other, "ceiling");
  EXPECT_PRED2(contains, blocked.text, "its lift stalls at 5500 N beneath ceiling");
  EXPECT_EQ(w.loadOf(1), 0);
  EXPECT_EQ(w.tower(1), 0);
  EXPECT_NEAR(w.unitPose(1).Z(), 0, 1e-9);
  w.world.remove("ceiling");  // and it can lift where there is room
  w.carry(1, 1);
  w.runUntilIdle(1);
  EXPECT_EQ(w.loadOf(1), 1);
}

TEST_F(Lift, StallsUnderALoadThatItsForceDoesNotLift) {
  w.world.remove("kiva1");
  w.spawnText(kivaText({{"max_force", "500"}}), "kiva1", 0, 0);  // 60 kg weigh 589 N
  w.carry(1, 1);
  w.runUntilIdle(1, 20);
  EXPECT_NEAR(w.unitPose(1).Z(), 0, 0.002);
  EXPECT_PRED2(contains, w.last(Event::Kind::kBlocked).text,
               "its lift stalls at 500 N: the load is too heavy");
}

}  // namespace
}  // namespace kiva::test
