// SPDX-License-Identifier: Apache-2.0
//
// Models are added, moved, reset and removed; a refused model leaves nothing behind.
#include <malloc.h>

#include <algorithm>
#include <random>

#include "core/state/world_state.h"
#include "warehouse.h"

namespace kiva::test {
namespace {

using Kind = Event::Kind;

std::string names(const std::string& kind, int id) { return kind + std::to_string(id); }

/// Everything that a half model could leave behind.
struct Inventory {
  std::vector<std::string> models;
  std::size_t slots, bodies, activated, with_plugins, units, items, robots, ids;
  int footprints = 0;
  double below;  // height of the first thing beneath (3, 0, 5), as Bullet sees it [m]

  explicit Inventory(const Warehouse& w) : models(w.world.modelNames()) {
    const WorldState& parts = insideOf(w.world);
    slots = parts.models.slot_of_name.size();
    bodies = parts.models.bodies.size();
    activated = parts.models.activated.size();
    with_plugins = parts.models.with_plugins.size();
    units = parts.storage.units.size();
    items = parts.storage.items.size();
    robots = parts.fleet.robots.size();
    ids = parts.storage.unit_of_id.size();
    parts.obstacles.near(0, 0, 1000, [this](const Footprint&) { ++footprints; });
    below = parts.physics.cast({3, 0, 5}, {0, 0, -1}, 10);
  }
  auto all() const {
    return std::tie(models, slots, bodies, activated, with_plugins, units, items, robots, ids,
                    footprints, below);
  }
  bool operator==(const Inventory& other) const { return all() == other.all(); }
};

/// A floor with a robot, a unit with an item, and a wall.
class Spawn : public ::testing::Test {
 protected:
  Spawn() {
    w.spawn("kiva", "kiva1", 0, 0);
    w.spawn("storage_unit", "storage_unit1", 0, 2);
    w.spawn("item", "item1", 0, 2, 0, 0.46);
    w.spawn("wall", "wall1", 0, 5);
    w.forget();
  }

  /// Returns the reason for which the world refuses the model, which must leave nothing behind,
  /// warnings included.
  std::string refusal(const std::string& text, const std::string& name,
                      const Pose& pose = Pose(3, 0, 0, 0, 0, 0)) {
    const Inventory before(w);
    const std::uint64_t revision = w.world.modelsRevision();
    std::string reason;
    try {
      w.world.spawn(instance(text, name, pose));
      ADD_FAILURE() << name << " was spawned";
    } catch (const DescriptionError& error) {
      reason = error.what();
    }
    EXPECT_TRUE(Inventory(w) == before) << reason;
    EXPECT_EQ(w.world.modelsRevision(), revision);
    EXPECT_TRUE(w.world.takeEvents().empty()) << reason;
    EXPECT_TRUE(w.world.takeStatusChanges().empty()) << reason;
    w.run(0.01);
    return reason;
  }

  Warehouse w;
};

// --- refusals

TEST_F(Spawn, RefusesATakenName) {
  for (const char* name : {"kiva1", "storage_unit1", "item1", "wall1", "ground_plane"}) {
    const std::string kind = std::string(name).substr(0, std::string(name).find_first_of("1"));
    const std::string text = kind == "ground_plane" ? modelText("wall") : modelText(kind);
    EXPECT_PRED2(contains, refusal(text, name), "entity already exists");
    EXPECT_TRUE(w.world.has(name));
  }
}

TEST_F(Spawn, RefusesAnUnfitName) {
  EXPECT_PRED2(contains, refusal(modelText("wall"), ""), "needs a name");
  EXPECT_PRED2(contains, refusal(modelText("wall"), "a::b"), "'::'");
  EXPECT_PRED2(contains, refusal(modelText("wall"), std::string(300, 'x')), "200 characters");
}

TEST_F(Spawn, RefusesARobotThatIsNotCalledKivaWithANumber) {
  for (const char* name : {"kiva", "kiva0", "kivaX", "kiva01", "kiva-1", "kiva1a", "kiva 2",
                           "Kiva2", "robot1", "kiva1000001", "kiva99999999999999999999"}) {
    EXPECT_PRED2(contains, refusal(kivaText(), name), "a robot is called kiva<id>");
  }
}

TEST_F(Spawn, RefusesAPoseThatIsNone) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  for (double bad : {nan, infinite, -infinite, 1e9}) {
    EXPECT_PRED2(contains, refusal(modelText("wall"), "wall2", Pose(bad, 0, 0, 0, 0, 0)), "pose");
    EXPECT_PRED2(contains, refusal(kivaText(), "kiva2", Pose(0, bad, 0, 0, 0, 0)), "pose");
    EXPECT_PRED2(contains, refusal(modelText("item"), "item2", Pose(0, 0, bad, 0, 0, 0)), "pose");
  }
  Pose turned;
  turned.Rot().Set(nan, 0, 0, 0);
  EXPECT_PRED2(contains, refusal(modelText("wall"), "wall2", turned), "pose");
}

TEST_F(Spawn, RefusesARobotThatLiesOrFloats) {
  EXPECT_PRED2(contains, refusal(kivaText(), "kiva2", Pose(3, 0, 0, 0.5, 0, 0)), "upright");
  EXPECT_PRED2(contains, refusal(kivaText(), "kiva2", Pose(3, 0, 2, 0, 0, 0)), "on the floor");
}

TEST_F(Spawn, RefusesALibraryWithoutAPluginAndNamesIt) {
  const std::string plugin = "<plugin name='own' filename='libkiva_core.so'/>";
  for (const auto& [kind, name] : {std::pair{"kiva", "kiva2"},
                                   {"storage_unit", "storage_unit2"},
                                   {"item", "item2"},
                                   {"wall", "wall2"}}) {
    EXPECT_PRED2(contains, refusal(withElement(modelText(kind), plugin), name), "libkiva_core.so");
  }
}

TEST_F(Spawn, RefusesAnUnknownOrWrongParameterAndNamesIt) {
  const std::string misspelt =
      replaced(replaced(kivaText(), "<speed>", "<sped>"), "/speed", "/sped");
  EXPECT_PRED2(contains, refusal(misspelt, "kiva2"), "'sped'");
  for (const auto& [key, value] : Changes{{"speed", "-1"},
                                          {"speed", "fast"},
                                          {"acceleration", "nan"},
                                          {"quarter_turn_time", "-1"},
                                          {"max_load", "-5"},
                                          {"rays", "1.5"},
                                          {"drive", "hover"}}) {
    EXPECT_PRED2(contains, refusal(kivaText({{key, value}}), "kiva2"), key);
  }
}

TEST_F(Spawn, RefusesPluginsWhereTheyDoNotBelong) {
  const std::string lift = "<plugin name='lift' filename='libkiva_lift.so'/>";
  EXPECT_PRED2(contains, refusal(withElement(modelText("wall"), lift), "wall2"), "libkiva_motion");
  const std::string grid = "<plugin name='grid' filename='libkiva_grid.so'/>";
  EXPECT_PRED2(contains, refusal(withElement(kivaText(), grid), "kiva2"), "plugin of a world");
}

TEST_F(Spawn, RefusesAJointedRobotWithoutWheels) {
  const std::string wheelless =
      replaced(kivaText({{"drive", "jointed"}}), "left_wheel", "port_wheel");
  EXPECT_PRED2(contains, refusal(wheelless, "kiva2"), "needs a link 'left_wheel'");
}

TEST_F(Spawn, RefusesARobotWithoutAShape) {
  std::string text = kivaText();
  while (contains(text, "<collision")) text = without(text, "<collision", "</collision>");
  EXPECT_PRED2(contains, refusal(text, "kiva2"), "needs a collision shape");
}

TEST_F(Spawn, TakesTheSameNameOnceTheFaultIsMended) {
  refusal(kivaText({{"speed", "-1"}}), "kiva2");
  w.spawn("kiva", "kiva2", 3, 0);
  w.movx(2, 1);
  w.runUntilIdle(2);
  w.expectAt(2, 4, 0);
}

TEST_F(Spawn, OfManyModelsComesAllOrNone) {
  const Inventory before(w);
  const auto many = [&](const std::string& last, const std::string& text) {
    return std::vector<ModelInstance>{
        instance(kivaText(), "kiva2", Pose(3, 0, 0, 0, 0, 0)),
        instance(modelText("storage_unit"), "storage_unit2", Pose(6, 0, 0, 0, 0, 0)),
        instance(modelText("item"), "item2", Pose(6, 0, 0.46, 0, 0, 0)),
        instance(text, last, Pose(9, 0, 0, 0, 0, 0))};
  };
  for (const char* last : {"kiva1", "kiva2", "kiva0"}) {
    EXPECT_THROW(w.world.spawn(many(last, kivaText())), DescriptionError) << last;
    EXPECT_TRUE(Inventory(w) == before) << last;
  }
  w.world.spawn(many("kiva3", kivaText()));
  EXPECT_EQ(w.world.fleet().size(), 3);
  w.carry(1, 2);
  EXPECT_PRED2(contains, w.refusal(), "m away");
}

// --- coming and going

TEST_F(Spawn, TellsWhoCameAndWent) {
  const std::uint64_t revision = w.world.modelsRevision();
  w.spawn("wall", "wall2", 3, 0);
  EXPECT_GT(w.world.modelsRevision(), revision);
  w.world.remove("wall2");
  EXPECT_GT(w.world.modelsRevision(), revision + 1);
  w.collect();
  EXPECT_EQ(w.kindsOf("wall2"), (std::vector<Kind>{Kind::kSpawned, Kind::kDeleted}));
}

TEST_F(Spawn, RemovesWhatIsThereAndNothingElse) {
  EXPECT_FALSE(w.world.remove("kiva9"));
  EXPECT_FALSE(w.world.remove(""));
  EXPECT_TRUE(w.world.remove("kiva1"));
  EXPECT_FALSE(w.world.remove("kiva1"));
  EXPECT_FALSE(w.world.has("kiva1"));
  EXPECT_EQ(w.world.fleet().find(1), -1);
  w.run(0.1);
}

TEST_F(Spawn, NamesModelsInTheOrderInWhichTheyCame) {
  w.world.remove("storage_unit1");  // its item goes as well
  w.spawn("wall", "wall2", 3, 0);
  w.spawn("storage_unit", "storage_unit1", 6, 0);
  EXPECT_EQ(w.world.modelNames(),
            (std::vector<std::string>{"ground_plane", "kiva1", "wall1", "wall2", "storage_unit1"}));
}

TEST_F(Spawn, ARobotThatComesAgainStandsAtItsNewPlace) {
  w.movx(1, 3);
  w.run(1);
  w.world.remove("kiva1");
  w.spawn("kiva", "kiva1", -4, 3, kQuarter);
  w.expectAt(1, -4, 3);
  EXPECT_NEAR(w.yaw(1), kQuarter, 1e-9);
  EXPECT_EQ(w.speed(1), 0);
  EXPECT_EQ(w.status(1), Status::kIdle);
  w.run(1);
  w.expectAt(1, -4, 3);
  w.movy(1, 2);
  w.runUntilIdle(1);
  w.expectAt(1, -4, 5);
}

TEST_F(Spawn, AUnitThatComesAgainStandsAtItsNewPlaceWithoutItems) {
  w.world.remove("storage_unit1");
  w.spawn("storage_unit", "storage_unit1", 7, 7, 0.5);
  EXPECT_NEAR(w.unitPose(1).X(), 7, 1e-9);
  EXPECT_NEAR(w.unitPose(1).Rot().Yaw(), 0.5, 1e-9);
  EXPECT_DOUBLE_EQ(w.unit(1).mass, 60);
}

TEST_F(Spawn, ANewRobotTellsItsStatus) {
  w.spawn("kiva", "kiva2", 3, 0);
  w.collect();
  ASSERT_EQ(w.changes.size(), 1u);
  EXPECT_EQ(w.changes[0].kiva_id, 2);
  EXPECT_EQ(w.changes[0].status, Status::kIdle);
}

TEST_F(Spawn, ARobotALittleAboveTheFloorIsPutOnIt) {
  w.spawn("kiva", "kiva2", 3, 0, 0, 0.3);
  EXPECT_EQ(w.world.state("kiva2")->pose.Z(), 0);
}

TEST_F(Spawn, AUnitAboveTheFloorFallsOnIt) {
  w.spawn("storage_unit", "storage_unit2", 5, 0, 0, 0.2);
  w.run(2);
  EXPECT_NEAR(w.unitPose(2).Z(), 0, kMillimetre);
  EXPECT_NEAR(w.unitPose(2).X(), 5, 0.05);
}

TEST_F(Spawn, WhatRestedOnADeletedModelFalls) {
  w.spawn("conveyor_belt", "conveyor_belt1", 10, 0);
  w.spawn("item", "item2", 10, 0, 0, 0.6);
  w.run(5);  // long enough to fall asleep
  ASSERT_NEAR(w.itemPose("item2").Z(), 0.6, 2 * kMillimetre);
  w.world.remove("conveyor_belt1");
  w.run(2);
  EXPECT_NEAR(w.itemPose("item2").Z(), 0, 2 * kMillimetre);
}

TEST_F(Spawn, ADeletedRobotIsInNobodysWay) {
  w.spawn("kiva", "kiva2", 4, 0);
  w.world.remove("kiva2");
  w.movx(1, 8);
  w.runUntilIdle(1);
  EXPECT_EQ(w.count(Kind::kDone), 1);
  w.expectAt(1, 8, 0);
}

TEST_F(Spawn, TheFloorIsWhatItsModelsCoverTogether) {
  const std::string plate =
      "<sdf version='1.9'><model name='m'><static>true</static><link name='l'><collision name='c'>"
      "<geometry><box><size>20 10 0.004</size></box></geometry></collision></link></model></sdf>";
  w.spawnText(plate, "annex", 60, 0);
  EXPECT_DOUBLE_EQ(w.world.floor().max_x, 70);
  EXPECT_DOUBLE_EQ(w.world.floor().max_y, 50);
  w.world.remove("ground_plane");
  EXPECT_DOUBLE_EQ(w.world.floor().min_x, 50);
  EXPECT_DOUBLE_EQ(w.world.floor().max_y, 5);
  w.world.remove("annex");
  EXPECT_DOUBLE_EQ(w.world.floor().max_x, 0);
}

/// Returns the program's use of the heap [MB]. Resident memory would not show allocations that
/// reuse freed memory.
double heldMemory() {
  const struct mallinfo2 heap = mallinfo2();
  return static_cast<double>(heap.uordblks + heap.hblkhd) / 1e6;
}

TEST_F(Spawn, TwoThousandComingsAndGoingsLeaveTheMemoryAsItWas) {
  const std::vector<std::pair<std::string, ModelInstance>> kinds = {
      {"kiva", instance(kivaText(), "")},
      {"storage_unit", instance(modelText("storage_unit"), "")},
      {"item", instance(modelText("item"), "")},
      {"wall", instance(modelText("wall"), "")}};
  const auto cycle = [&](int i) {
    for (const auto& [kind, model] : kinds) {
      ModelInstance next = model;
      next.name = names(kind, 100 + i % 7);
      next.pose = Pose(i % 40 - 20, 10, kind == "item" ? 0.46 : 0, 0, 0, 0);
      w.world.spawn(next);
    }
    w.step();
    for (const auto& [kind, model] : kinds) w.world.remove(names(kind, 100 + i % 7));
    w.forget();
  };
  for (int i = 0; i < 500; ++i) cycle(i);
  const double before = heldMemory();
  for (int i = 0; i < 2000; ++i) cycle(i);
  EXPECT_LT(heldMemory() - before, 0.1);
}

// --- states

TEST_F(Spawn, TellsTheStateOfModelsAndLinks) {
  EXPECT_FALSE(w.world.state("missing"));
  EXPECT_FALSE(w.world.state("kiva1", "antenna"));
  EXPECT_NEAR(w.world.state("kiva1", "left_wheel")->pose.Y(), 0.26, 1e-9);
  EXPECT_NEAR(w.world.state("kiva1", "right_wheel")->pose.Y(), -0.26, 1e-9);
  EXPECT_NEAR(w.world.state("kiva1", "tower")->pose.Z(), 0.38, 1e-9);
  EXPECT_NEAR(w.world.state("wall1")->pose.Y(), 5, 1e-9);
  EXPECT_NEAR(w.world.state("item1")->pose.Z(), 0.46, 1e-9);
}

TEST_F(Spawn, TheWheelsTurnAsTheRobotDrives) {
  w.movx(1, 1);
  w.runUntilIdle(1);
  const Quaternion wheel = w.world.state("kiva1", "left_wheel")->pose.Rot();
  const Vector3 spoke = wheel.RotateVector(Vector3::UnitZ);  // pointed up a metre ago
  const double angle = 1 / 0.1;                              // way over radius [rad]
  EXPECT_NEAR(spoke.X(), std::sin(angle), 0.01);
  EXPECT_NEAR(spoke.Z(), std::cos(angle), 0.01);
  EXPECT_NEAR(w.world.state("kiva1", "left_wheel")->pose.X(), 1, kMillimetre);
}

TEST_F(Spawn, TheTowerRisesAsTheRobotLifts) {
  w.world.setState("kiva1", {Pose(0, 2, 0, 0, 0, 0), {}});
  w.carry(1, 1);
  w.runUntilIdle(1);
  EXPECT_NEAR(w.world.state("kiva1", "tower")->pose.Z(), 0.48, 1e-9);
  EXPECT_NEAR(w.world.state("kiva1", "chassis")->pose.Z(), 0, 1e-9);
}

TEST_F(Spawn, VelocitiesAreThoseOfTheMotion) {
  w.movx(1, 5);
  w.run(2);
  const double x = w.x(1);
  const Twist twist = w.world.state("kiva1")->twist;
  w.run(0.01);
  EXPECT_NEAR(twist.linear.X(), (w.x(1) - x) / 0.01, 0.01);
  w.runUntilIdle(1);
  w.rot(1, kLeft);
  w.run(0.3);
  const double rate = w.world.state("kiva1")->twist.angular.Z();
  EXPECT_GT(rate, 1);
  // The front of the chassis moves sideways.
  EXPECT_NEAR(w.world.state("kiva1", "left_wheel")->twist.linear.Length(), 0.26 * rate, 1e-6);
}

TEST_F(Spawn, TellsAllStatesInTheOrderOfTheNames) {
  w.world.remove("wall1");
  w.spawn("item", "item2", 8, 8, 0, 1);
  w.movx(1, 5);
  w.run(0.3);
  std::vector<EntityState> states;
  w.world.states(&states);
  const std::vector<std::string> names = w.world.modelNames();
  ASSERT_EQ(states.size(), names.size());
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_EQ(states[i].pose, w.world.state(names[i])->pose) << names[i];
    EXPECT_EQ(states[i].twist.linear, w.world.state(names[i])->twist.linear) << names[i];
  }
}

// --- moved by hand

TEST_F(Spawn, NobodyCanBeMovedWhoIsNotThere) {
  EXPECT_FALSE(w.world.setState("missing", {}));
  EXPECT_FALSE(w.world.applyWrench("missing", "link", {1, 0, 0}, {}));
  EXPECT_FALSE(w.world.applyWrench("wall1", "body", {1, 0, 0}, {}));
}

TEST_F(Spawn, NobodyIsMovedToNowhere) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const std::string& name : w.world.modelNames()) {
    const Pose before = w.world.state(name)->pose;
    EXPECT_THROW(w.world.setState(name, {Pose(nan, 0, 0, 0, 0, 0), {}}), DescriptionError);
    EXPECT_THROW(w.world.setState(name, {Pose(1e9, 0, 0, 0, 0, 0), {}}), DescriptionError);
    EXPECT_THROW(w.world.setState(name, {before, {{nan, 0, 0}, {}}}), DescriptionError);
    EXPECT_EQ(w.world.state(name)->pose, before);
  }
}

TEST_F(Spawn, ARobotMovedOnItsWayEndsItsCommandInBlocked) {
  w.movx(1, 5);
  w.run(2);
  w.world.setState("kiva1", {Pose(8, 8, 0, 0, 0, M_PI), {}});
  w.run(0.5);
  EXPECT_EQ(w.count(Kind::kBlocked, "kiva1"), 1);
  EXPECT_EQ(w.status(1), Status::kIdle);
  w.expectAt(1, 8, 8);
  w.movx(1, -2);
  w.runUntilIdle(1);
  w.expectAt(1, 6, 8);
}

TEST_F(Spawn, ARobotThrownByHandBrakesAndStands) {
  w.world.setState("kiva1", {Pose(0, 0, 0, 0, 0, 0), {{1, 0, 0}, {}}});
  w.run(3);
  EXPECT_EQ(w.speed(1), 0);
  EXPECT_GT(w.x(1), 0.01);
  EXPECT_LT(w.x(1), 0.5);
}

TEST_F(Spawn, AUnitHeldInTheAirFalls) {
  w.world.setState("storage_unit1", {Pose(0, 8, 0.3, 0, 0, 0), {}});
  w.run(2);
  EXPECT_NEAR(w.unitPose(1).Z(), 0, kMillimetre);
  EXPECT_NEAR(w.itemPose("item1").Y(), 8, 0.05);
}

TEST_F(Spawn, AUnitThatFellOverLiesStillAndCanNotBeCarried) {
  w.world.setState("storage_unit1", {Pose(0, 8, 0.5, M_PI / 2, 0, 0), {}});
  w.run(6);
  const Pose pose = w.unitPose(1);
  EXPECT_NEAR(pose.Rot().ZAxis().Z(), 0, 0.01);
  const std::uint64_t revision = w.world.unitsRevision();
  w.run(0.5);
  EXPECT_EQ(w.world.unitsRevision(), revision);
  w.spawn("kiva", "kiva2", pose.X(), pose.Y());
  w.carry(2, 1);
  EXPECT_PRED2(contains, w.refusal(), "does not stand upright");
}

TEST_F(Spawn, AnItemMovedOnItsUnitStaysThere) {
  w.world.setState("item1", {Pose(0.2, 2.2, 0.81, 0, 0, 0), {}});
  w.run(0.1);
  EXPECT_NEAR(w.itemPose("item1").Z(), 0.81, 1e-9);
  w.world.setState("storage_unit1", {Pose(4, 2, 0, 0, 0, 0), {}});
  w.run(0.1);
  EXPECT_NEAR(w.itemPose("item1").X(), 4.2, kMillimetre);
}

TEST_F(Spawn, AMovedWallBlocksWhereItIsNow) {
  w.world.setState("wall1", {Pose(4, 0, 0, 0, 0, kQuarter), {}});
  EXPECT_NEAR(w.world.rayCast({0.5, 0, 0.2}, 0, 10), 3.4, 1e-6);
  EXPECT_NEAR(insideOf(w.world).physics.cast({0.5, 0, 0.2}, {1, 0, 0}, 10), 3.4, 1e-2);
  EXPECT_TRUE(std::isinf(w.world.rayCast({0, 1, 0.6}, kQuarter, 10)) ||
              w.world.rayCast({0, 3, 0.6}, kQuarter, 10) > 5);
}

TEST_F(Spawn, ARobotIsSeenHoweverFarItGoes) {
  for (int x = 1; x <= 40; ++x) {
    w.movx(1, 1);
    w.runUntilIdle(1);
    for (double across : {-0.3, 0.0, 0.3}) {  // parts of it are in other cells than its centre
      EXPECT_NEAR(w.world.rayCast({x + across, -2, 0.2}, kQuarter, 10), 2 - 0.32, 1e-6)
          << across << " m off the centre at x = " << x;
    }
  }
}

// --- reset

TEST_F(Spawn, ResetPutsEverythingBack) {
  w.spawn("item", "item2", 8, 8, 0, 1);
  const std::vector<std::string> names = w.world.modelNames();
  std::vector<EntityState> before, after;
  w.world.states(&before);
  w.world.setState("kiva1", {Pose(0, 2, 0, 0, 0, 0), {}});
  w.carry(1, 1);
  w.runUntilIdle(1);
  w.movx(1, 5);
  w.run(3);
  w.world.setState("wall1", {Pose(9, 9, 0, 0, 0, 1), {}});
  w.world.setState("item1", {w.itemPose("item1") * Pose(0.1, 0, 0.35, 0, 0, 0), {}});
  const std::uint64_t revision = w.world.unitsRevision();
  w.world.reset(false);
  w.world.states(&after);
  for (std::size_t i = 0; i < names.size(); ++i) {
    EXPECT_LT((before[i].pose.Pos() - after[i].pose.Pos()).Length(), 1e-9) << names[i];
    EXPECT_LT((before[i].pose.Rot().Inverse() * after[i].pose.Rot()).Euler().Length(), 1e-9);
    EXPECT_EQ(after[i].twist.linear, Vector3::Zero) << names[i];
  }
  EXPECT_GT(w.world.unitsRevision(), revision);
  EXPECT_EQ(w.tower(1), 0);
  EXPECT_EQ(w.loadOf(1), 0);
  EXPECT_EQ(w.status(1), Status::kIdle);
}

TEST_F(Spawn, ResetOfAUnitThatWasCarriedAwayIsToldToTrackers) {
  w.world.setState("kiva1", {Pose(0, 2, 0, 0, 0, 0), {}});
  w.carry(1, 1);
  w.runUntilIdle(1);
  w.movx(1, 5);
  w.runUntilIdle(1);
  w.drop(1, 1);
  w.runUntilIdle(1);
  w.run(1);
  const std::uint64_t revision = w.world.unitsRevision();
  w.world.reset(false);
  EXPECT_NEAR(w.unitPose(1).X(), 0, 1e-9);
  EXPECT_GT(w.world.unitsRevision(), revision);
}

TEST_F(Spawn, ResetEndsCommandsInBlockedAndRobotsObeyAgain) {
  w.movx(1, 5);
  w.run(1);
  w.world.reset(true);
  w.run(1);
  EXPECT_EQ(w.count(Kind::kBlocked, "kiva1"), 1);
  w.expectAt(1, 0, 0);
  w.movy(1, -2);
  w.runUntilIdle(1);
  w.expectAt(1, 0, -2);
}

TEST_F(Spawn, ResetTakesTimeBackOnlyIfAsked) {
  w.run(0.5);
  w.world.reset(false);
  EXPECT_NEAR(w.world.time(), 0.5, 1e-9);
  w.world.reset(true);
  EXPECT_EQ(w.world.time(), 0);
  w.run(0.25);
  EXPECT_NEAR(w.world.time(), 0.25, 1e-9);
}

TEST_F(Spawn, ResetWhileTheTowerRisesLeavesUnitAndRobotApart) {
  w.world.setState("kiva1", {Pose(0, 2, 0, 0, 0, 0), {}});
  w.carry(1, 1);
  w.runUntil([&] { return w.tower(1) > 0.05; }, 5);
  w.world.reset(true);
  w.run(3);
  EXPECT_EQ(w.tower(1), 0);
  EXPECT_EQ(w.unitPose(1).Z(), 0);
  w.mov(1, 0, 2);
  w.runUntilIdle(1);
  w.carry(1, 1);
  w.runUntilIdle(1);
  EXPECT_EQ(w.loadOf(1), 1);
}

}  // namespace
}  // namespace kiva::test
