// SPDX-License-Identifier: Apache-2.0
//
// Items that fall off a storage unit which is hit or tips, and are picked up.
#include <algorithm>
#include <cmath>
#include <set>

#include "core/state/world_state.h"
#include "warehouse.h"

namespace kiva::test {
namespace {

using Kind = Event::Kind;

constexpr double kGravity = 9.81;  // [m/s²]
constexpr double kFriction = 0.4;  // of items on their boards
constexpr double kItem = 1.5;      // [kg]
constexpr double kHalfUnit = 0.4;  // [m]
constexpr double kBoard = 0.81;    // [m], the second one
constexpr double kFront = 0.24;    // [m] from the middle of the unit to the items of its first row
constexpr double kBar = 6;         // [m], where something low stands in the way

/// Sudden change of a unit's speed from which items of its first row slide off [m/s].
const double kLimit = std::sqrt(2 * kFriction * kGravity * (kHalfUnit - kFront));

Floorplan planWith(double least, double most, double pick_up_after = 0) {
  Floorplan plan{60};
  plan.options.realism.emplace();
  plan.options.realism->loads = {true, 100, least, most, pick_up_after};
  return plan;
}

std::string barText() {
  return "<sdf version='1.9'><model name='bar'><static>true</static><link name='l'><collision "
         "name='c'><pose>0 0 0.2 0 0 0</pose><geometry><box><size>0.1 3 0.4</size></box></geometry>"
         "</collision></link></model></sdf>";
}

/// Three rows of four items on one board of a unit that stands at (0, 0); the first four are those
/// at the front.
void fill(Warehouse* w, const std::string& unit) {
  w->spawnText(unit, "storage_unit1", 0, 0);
  int number = 0;
  for (const double x : {kFront, 0.0, -kFront}) {
    for (const double y : {-0.27, -0.09, 0.09, 0.27}) {
      w->spawn("item", "item" + std::to_string(++number), x, y, 0, kBoard);
    }
  }
}

/// A storage unit so heavy at its underside that it does not tip off its robot.
std::string lowUnit() {
  return replaced(modelText("storage_unit"), "<pose>0 0 1.0 0 0 0</pose>",
                  "<pose>0 0 0.45 0 0 0</pose>");
}

/// A robot that can't see, with a full unit on it, on its way at that speed to a low bar.
class Blind : public Warehouse {
 public:
  Blind(double speed, const Floorplan& plan) : Warehouse(plan) {
    const std::string kiva = kivaText({{"speed", number(speed)}});
    spawnText(withoutPlugin(kiva, "laser"), "kiva1", 0, 0);
    fill(this, lowUnit());
    carry(1, 1);
    runUntilIdle(1);
    spawnText(barText(), "bar", kBar, 0);
    movx(1, 10);
  }
  void hit() {
    runUntil([this] { return count(Kind::kCollision) > 0; });
  }
};

std::set<std::string> fallen(const World& world) {
  std::set<std::string> names;
  for (const FallenItem& item : world.fallenItems()) names.insert(item.name);
  return names;
}

std::set<std::string> whoFalls(double speed, const Floorplan& plan) {
  Blind w(speed, plan);
  w.hit();
  w.run(2);
  return fallen(w.world);
}

const std::set<std::string> kFirstRow = {"item1", "item2", "item3", "item4"};

TEST(Items, FallIfTheirUnitIsHitHarderThanFrictionHolds) {
  const Floorplan plan = planWith(kFriction, kFriction);
  EXPECT_TRUE(whoFalls(0.95 * kLimit, plan).empty());
  EXPECT_EQ(whoFalls(1.05 * kLimit, plan), kFirstRow);
}

/// Who falls off a unit that stands, and is hit from behind by something low of 300 kg.
std::set<std::string> whoFallsOfThoseThatStand(double speed) {
  Warehouse w(planWith(kFriction, kFriction));
  fill(&w, lowUnit());
  w.spawnText(
      "<sdf version='1.9'><model name='crate'><link name='l'><pose>0 0 0.2 0 0 0</pose><inertial>"
      "<mass>300</mass><inertia><ixx>24</ixx><iyy>10</iyy><izz>27</izz></inertia></inertial>"
      "<collision name='c'><geometry><box><size>0.5 0.9 0.4</size></box></geometry></collision>"
      "</link></model></sdf>",
      "crate", -kHalfUnit - 0.252, 0);
  w.world.setState("crate", {w.world.state("crate")->pose, {Vector3(speed, 0, 0), Vector3::Zero}});
  w.run(2);
  return fallen(w.world);
}

TEST(Items, FallOffAUnitThatStandsAndIsHit) {
  const double share = 300 / (300 + 60 + 12 * kItem);  // of its speed that both have afterwards
  EXPECT_TRUE(whoFallsOfThoseThatStand(0.9 * kLimit / share).empty());
  const std::set<std::string> last_row = {"item10", "item11", "item12", "item9"};
  EXPECT_EQ(whoFallsOfThoseThatStand(1.1 * kLimit / share), last_row);
}

TEST(Items, StayIfLoadsAreIdeal) {
  Floorplan plan{60};
  EXPECT_TRUE(whoFalls(1.5, plan).empty());
}

TEST(Items, AreDrawnByTheSeed) {
  // Of those within friction 0.2 to 0.6, a speed of 0.4's limit sets half of the first row free.
  Floorplan plan = planWith(0.2, 0.6);
  std::set<std::set<std::string>> outcomes;
  double all = 0;
  for (std::uint64_t seed = 1; seed <= 12; ++seed) {
    plan.options.seed = seed;
    const std::set<std::string> names = whoFalls(kLimit, plan);
    EXPECT_TRUE(std::includes(kFirstRow.begin(), kFirstRow.end(), names.begin(), names.end()));
    outcomes.insert(names);
    all += static_cast<double>(names.size());
  }
  EXPECT_NEAR(all, 24, 10);  // three standard deviations
  EXPECT_GT(outcomes.size(), 3u);
  EXPECT_EQ(whoFalls(kLimit, plan), whoFalls(kLimit, plan));
}

TEST(Items, LieOnTheFloorAfterwardsAndAreTold) {
  Blind w(1.5, planWith(kFriction, kFriction));
  const double full = w.unit(1).mass;
  w.hit();
  w.run(6);
  ASSERT_EQ(w.count(Kind::kFell), 4);
  EXPECT_EQ(w.last(Kind::kFell).other, "storage_unit1");
  EXPECT_PRED2(contains, w.last(Kind::kFell).text, " falls off storage_unit1 at (6.");
  EXPECT_NEAR(w.unit(1).mass, full - 4 * kItem, 1e-9);
  const WorldState& inside = insideOf(w.world);
  for (const FallenItem& item : w.world.fallenItems()) {
    EXPECT_EQ(item.unit, "storage_unit1");
    EXPECT_LT(item.pose.Z(), 0.21) << item.name;  // on whichever side
    EXPECT_GT(item.pose.X(), kBar) << item.name;
    EXPECT_FALSE(isAwake(*inside.models.find(item.name))) << item.name;
  }
}

TEST(Items, CloseTheirCellsUntilTheyArePickedUp) {
  Blind w(1.5, planWith(kFriction, kFriction));
  const double full = w.unit(1).mass;
  const Pose place = w.unitPose(1).Inverse() * w.itemPose("item1");
  w.hit();
  w.run(4);
  const Pose lies = w.itemPose("item1");
  const auto cellThere = [&] {
    const Occupancy map = w.world.occupancy();
    const auto column = std::lround((lies.X() - map.x) / map.spacing);
    const auto row = std::lround((lies.Y() - map.y) / map.spacing);
    return map.cells[row * map.columns + column];
  };
  w.world.remove("bar");
  EXPECT_EQ(cellThere(), Occupancy::kTaken);
  for (const std::string& name : kFirstRow) w.world.pickUp(name);
  w.step();
  EXPECT_EQ(w.count(Kind::kPickedUp), 4);
  EXPECT_EQ(cellThere(), Occupancy::kFree);
  EXPECT_TRUE(w.world.fallenItems().empty());
  EXPECT_NEAR(w.unit(1).mass, full, 1e-9);
  const Pose back = w.unitPose(1).Inverse() * w.itemPose("item1");
  EXPECT_LT((back.Pos() - place.Pos()).Length(), 1e-9);
  EXPECT_THROW(w.world.pickUp("item1"), std::invalid_argument);
}

TEST(Items, ArePickedUpBySomebodyInTime) {
  Blind w(1.5, planWith(kFriction, kFriction, 5));
  w.hit();
  w.run(5);
  EXPECT_EQ(w.count(Kind::kPickedUp), 0);
  w.run(1);
  EXPECT_EQ(w.count(Kind::kPickedUp), 4);
}

TEST(Items, StayWhereSomethingStandsAgainstTheirShelf) {
  Floorplan plan = planWith(kFriction, kFriction);
  Blind w(1.5, plan);
  w.world.remove("bar");
  w.spawnText(replaced(replaced(barText(), "0.1 3 0.4", "0.1 3 2"), "0 0 0.2", "0 0 1"), "wall",
              kBar, 0);
  w.hit();
  w.run(2);
  EXPECT_TRUE(fallen(w.world).empty());
}

TEST(Items, SlideOffAUnitThatTips) {
  Warehouse w(planWith(0.2, 0.6));
  fill(&w, modelText("storage_unit"));
  w.world.setState("storage_unit1", {Pose(0, 0, 0.3, 0, 0.7, 0), {}});
  w.run(8, [&] {
    for (const FallenItem& item : w.world.fallenItems()) {
      const Vector3 speed = w.world.state(item.name)->twist.linear;
      ASSERT_LT(speed.Length(), 6) << item.name;  // what falls from the top has 5.9 m/s
      ASSERT_GT(item.pose.Z(), -0.01) << item.name;
    }
  });
  const std::set<std::string> names = fallen(w.world);
  EXPECT_TRUE(std::includes(names.begin(), names.end(), kFirstRow.begin(), kFirstRow.end()));
  EXPECT_EQ(w.count(Kind::kCollision), 0);                       // each falls off what it touches
  EXPECT_THROW(w.world.pickUp("item1"), std::invalid_argument);  // its unit lies
  w.world.setState("storage_unit1", {Pose(9, 9, 0, 0, 0, 0), {}});
  w.world.pickUp("item1");
  EXPECT_NEAR(w.itemPose("item1").X(), 9 + kFront, 1e-6);
}

TEST(Items, FallTheSameFromACheckpointOn) {
  Blind w(1.5, planWith(kFriction, kFriction, 3));
  w.hit();
  for (const double wait : {0.05, 0.25, 1.0}) {  // they slide, fall, lie
    w.run(wait);
    World other{WorldDescription()};
    other.restore(w.world.checkpoint());
    World later{WorldDescription()};
    later.restore(w.world.checkpoint());
    for (int i = 0; i < 4000; ++i) {
      other.step();
      later.step();
    }
    EXPECT_EQ(other.stateHash(), later.stateHash());
    Blind again(1.5, planWith(kFriction, kFriction, 3));
    while (again.world.steps() < other.steps()) again.step();
    EXPECT_EQ(other.stateHash(), again.world.stateHash()) << wait;
    EXPECT_EQ(again.count(Kind::kPickedUp), 4);
  }
}

TEST(Items, GoWithTheirWorld) {
  Blind w(1.5, planWith(kFriction, kFriction));
  w.hit();
  w.run(2);
  ASSERT_EQ(w.world.fallenItems().size(), 4u);
  w.world.remove("item1");
  EXPECT_EQ(w.world.fallenItems().size(), 3u);
  World other{WorldDescription()};
  other.restore(w.world.checkpoint());
  other.reset(true);
  EXPECT_TRUE(other.fallenItems().empty());
  EXPECT_NEAR(other.state("item2")->pose.X(), kFront, 1e-9);
  w.world.remove("storage_unit1");
  EXPECT_TRUE(w.world.fallenItems().empty());
  EXPECT_TRUE(w.world.has("item2"));  // it lies there still
  EXPECT_FALSE(w.world.has("item5"));
  w.run(0.1);
}

}  // namespace
}  // namespace kiva::test
