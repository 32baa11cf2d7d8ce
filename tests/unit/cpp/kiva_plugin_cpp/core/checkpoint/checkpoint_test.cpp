// SPDX-License-Identifier: Apache-2.0
//
// A restored world continues exactly as the saved one, bit by bit.
#include "core/checkpoint/checkpoint.h"

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <functional>
#include <memory>
#include <random>

#include "damaged_checkpoint.h"
#include "warehouse.h"

namespace kiva::test {
namespace {

using Hashes = std::vector<std::uint64_t>;

/// Returns a random command to a random robot.
Command anyCommand(std::mt19937& random, int robots, int units) {
  const auto pick = [&](int least, int most) {
    return std::uniform_int_distribution<int>(least, most)(random);
  };
  Command command;
  command.kind = static_cast<Command::Kind>(pick(0, 4));
  command.kiva_id = pick(1, robots);
  command.x = command.kind == Command::Kind::kMoveTo ? pick(-4, 4) : pick(-2, 2);
  command.y = command.kind == Command::Kind::kMoveTo ? pick(-4, 4) : pick(-2, 2);
  command.direction = pick(0, 1) ? 1 : -1;
  command.lift = pick(0, 1);
  command.shelf_id = pick(1, units);
  return command;
}

/// Steps `steps` times with commands from that seed; returns the state's hash after every 50 steps.
Hashes goOn(World& world, int steps, unsigned seed) {
  std::mt19937 random(seed);
  Hashes hashes;
  for (int i = 0; i < steps; ++i) {
    if (i % 50 == 0) world.post(anyCommand(random, 8, 4));
    world.step();
    if (i % 50 == 49) hashes.push_back(world.stateHash());
  }
  world.takeEvents();
  world.takeStatusChanges();
  return hashes;
}

std::string bodyText(const std::string& shape, double mass) {
  return "<sdf version='1.9'><model name='thing'><link name='link'><inertial><mass>" +
         number(mass) + "</mass><inertia><ixx>0.1</ixx><iyy>0.1</iyy><izz>0.1</izz></inertia>" +
         "</inertial><collision name='c'><geometry>" + shape +
         "</geometry></collision></link></model></sdf>";
}
std::string boxText() { return bodyText("<box><size>0.3 0.3 0.3</size></box>", 5); }
std::string ballText() { return bodyText("<sphere><radius>0.15</radius></sphere>", 3); }
std::string barrelText() {
  return bodyText("<cylinder><radius>0.2</radius><length>0.4</length></cylinder>", 4);
}

const char kSwing[] =
    "<sdf version='1.9'><model name='swing'>"
    "<link name='post'><pose>0 0 1 0 0 0</pose><inertial><mass>1</mass></inertial></link>"
    "<link name='arm'><pose>0.4 0 1 0 0 0</pose><inertial><mass>1</mass></inertial>"
    "<collision name='c'><geometry><box><size>0.3 0.05 0.05</size></box></geometry></collision>"
    "</link>"
    "<joint name='j' type='fixed'><parent>world</parent><child>post</child></joint>"
    "<joint name='h' type='revolute'><pose>-0.4 0 0 0 0 0</pose><parent>post</parent>"
    "<child>arm</child><axis><xyz>0 1 0</xyz></axis></joint></model></sdf>";

/// Two boxes and a ball in one link: several contacts between the same two bodies.
const char kTable[] =
    "<sdf version='1.9'><model name='table'><link name='link'><inertial><mass>8</mass><inertia>"
    "<ixx>0.5</ixx><iyy>0.5</iyy><izz>0.5</izz></inertia></inertial>"
    "<collision name='a'><pose>0.4 0 0 0 0 0</pose><geometry><box><size>0.1 0.6 0.4</size></box>"
    "</geometry></collision><collision name='b'><pose>-0.4 0 0 0 0 0</pose><geometry><box>"
    "<size>0.1 0.6 0.4</size></box></geometry></collision><collision name='c'>"
    "<pose>0 0 0.25 0 0 0</pose><geometry><sphere><radius>0.1</radius></sphere></geometry>"
    "</collision></link></model></sdf>";

/// A small hall with too many robots, so that they meet; units with items, belts, loose things.
void furnish(Warehouse& w) {
  for (int i = 0; i < 8; ++i) w.spawn("kiva", "kiva" + std::to_string(i + 1), i % 4 - 2, i / 4);
  for (int i = 0; i < 4; ++i) {
    w.spawn("storage_unit", "storage_unit" + std::to_string(i + 1), i - 2, 3);
    w.spawn("item", "item" + std::to_string(i + 1), i - 2, 3, 0, 0.8);
  }
  w.spawn("conveyor_belt", "conveyor_belt1", 4, -3);
  w.spawn("person", "person1", -3, -3);
  w.spawnText(boxText(), "box", 0.5, 1.5, 0.3, 0.5);
  w.spawnText(ballText(), "ball", -1.5, -0.5, 0, 0.15);
  w.spawnText(barrelText(), "barrel", 1.5, -1.5, 0, 0.2);
  w.spawnText(kSwing, "swing", -4, 4);
  EntityState rolling = *w.world.state("ball");
  rolling.twist.linear.Set(1.5, 0.4, 0);
  w.world.setState("ball", rolling);
}

Floorplan hall() {
  Floorplan plan;
  plan.size = 12;
  return plan;
}

class Checkpoint : public ::testing::Test {
 protected:
  Checkpoint() : w(hall()) { furnish(w); }
  Warehouse w;
};

TEST_F(Checkpoint, RestoredWorldGoesOnAsTheSavedOneDid) {
  goOn(w.world, 3000, 1);
  const std::string saved = w.world.checkpoint();
  const std::uint64_t hash = w.world.stateHash();
  const Hashes first = goOn(w.world, 5000, 2);
  w.world.restore(saved);
  EXPECT_EQ(w.world.stateHash(), hash);
  EXPECT_EQ(goOn(w.world, 5000, 2), first);
}

TEST_F(Checkpoint, HashTellsDifferentCommandsApart) {
  const std::string saved = w.world.checkpoint();
  const Hashes first = goOn(w.world, 1000, 2);
  w.world.restore(saved);
  EXPECT_NE(goOn(w.world, 1000, 3), first);
}

TEST_F(Checkpoint, AnyWorldBecomesTheSavedOne) {
  goOn(w.world, 4000, 3);
  const std::string saved = w.world.checkpoint();
  const Hashes first = goOn(w.world, 4000, 4);
  Warehouse fresh{hall()}, other{"paper.sdf"};
  for (World* world : {&fresh.world, &other.world}) {
    world->restore(saved);
    EXPECT_EQ(world->modelNames(), w.world.modelNames());
    EXPECT_EQ(goOn(*world, 4000, 4), first);
    EXPECT_TRUE(world->checkpoint() == w.world.checkpoint());
  }
}

TEST_F(Checkpoint, HoldsTheModesOfRobots) {
  const int id = w.world.fleet().robots[0].id;
  w.world.keepMode(id, 1);
  const std::string saved = w.world.checkpoint();
  w.world.keepMode(id, 0);
  w.world.restore(saved);
  EXPECT_EQ(w.world.fleet().mode[0], 1);
  w.world.reset(true);
  EXPECT_EQ(w.world.fleet().mode[0], 1);
  EXPECT_THROW(w.world.keepMode(id, 3), std::invalid_argument);
  EXPECT_THROW(w.world.keepMode(99999, 1), std::invalid_argument);
}

TEST_F(Checkpoint, AHundredAtRandomMoments) {
  std::mt19937 random(7);
  for (int round = 0; round < 100; ++round) {
    goOn(w.world, std::uniform_int_distribution<int>(1, 700)(random), 100 + round);
    const std::string saved = w.world.checkpoint();
    const Hashes first = goOn(w.world, 300, 500 + round);
    w.world.restore(saved);
    ASSERT_EQ(goOn(w.world, 300, 500 + round), first) << "round " << round;
  }
}

TEST(CheckpointOfALift, GoesOnInTheMiddle) {
  Warehouse w;
  w.spawn("kiva", "kiva1", 0, 0);
  w.spawn("storage_unit", "storage_unit1", 0, 0);
  w.carry(1, 1);
  w.runUntil([&w] { return w.loadOf(1) == 1; });
  w.run(0.3);
  ASSERT_EQ(w.state(1), State::kLifting);
  const std::string saved = w.world.checkpoint();
  w.forget();
  w.runUntilIdle(1);
  const double height = w.unitPose(1).Z();
  const std::vector<Event> events = w.events;
  w.world.restore(saved);
  EXPECT_EQ(w.state(1), State::kLifting);
  EXPECT_LT(w.unitPose(1).Z(), height);
  w.forget();
  w.runUntilIdle(1);
  EXPECT_EQ(w.unitPose(1).Z(), height);
  ASSERT_EQ(w.events.size(), events.size());
  for (std::size_t i = 0; i < events.size(); ++i) {
    EXPECT_EQ(w.events[i].time, events[i].time);
    EXPECT_EQ(w.events[i].kind, events[i].kind);
  }
}

TEST_F(Checkpoint, JointedRobotsToo) {
  Floorplan plan = hall();
  plan.options.drive = Drive::kJointed;
  Warehouse jointed(plan);
  for (int i = 0; i < 3; ++i) jointed.spawn("kiva", "kiva" + std::to_string(i + 1), i, 0);
  goOn(jointed.world, 1500, 5);
  const std::string saved = jointed.world.checkpoint();
  const Hashes first = goOn(jointed.world, 2000, 6);
  jointed.world.restore(saved);
  EXPECT_EQ(goOn(jointed.world, 2000, 6), first);
}

/// Adds bodies that fall, roll, lean on each other and hang on joints, with robots among them, from
/// that seed.
void heap(Warehouse& w, unsigned seed) {
  std::mt19937 random(seed);
  const auto at = [&random] { return std::uniform_real_distribution<double>(-1.5, 1.5)(random); };
  const auto name = [](const char* kind, int i) { return kind + std::to_string(i); };
  for (int i = 0; i < 5; ++i) {
    w.spawnText(boxText(), name("stacked", i), 2.5, 2.5, 0, 0.151 + 0.301 * i);
    w.spawnText(i % 2 ? ballText() : barrelText(), name("round", i), at(), at(), 0, 0.5 + 0.4 * i);
    w.spawnText(boxText(), name("box", i), at(), at(), at(), 0.7 + 0.4 * i);
    w.spawnText(kSwing, name("swing", i), at(), at(), at(), 0.5 * i);
  }
  w.spawnText(kTable, "table", at(), at(), 0.3, 1.2);
  for (int i = 0; i < 4; ++i) w.spawn("storage_unit", name("storage_unit", i + 1), i - 2, 3);
  for (int i = 0; i < 8; ++i) w.spawn("kiva", name("kiva", i + 1), i - 4, i % 2 ? -3 : 3);
  EntityState rolling = *w.world.state("round1");
  rolling.twist.linear.Set(2, 1, 0);
  w.world.setState("round1", rolling);
}

struct SavedScene {
  const char* name;
  Drive drive;
  void (*fill)(Warehouse&, unsigned seed);
};

class CheckpointIn : public ::testing::TestWithParam<SavedScene> {
 protected:
  std::unique_ptr<Warehouse> make(unsigned seed) const {
    Floorplan plan = hall();
    plan.options.drive = GetParam().drive;
    auto w = std::make_unique<Warehouse>(plan);
    GetParam().fill(*w, seed);
    return w;
  }
};

INSTANTIATE_TEST_SUITE_P(, CheckpointIn,
                         ::testing::Values(SavedScene{"AHall", Drive::kTraction,
                                                      [](Warehouse& w, unsigned) { furnish(w); }},
                                           SavedScene{"AHeap", Drive::kTraction, heap},
                                           SavedScene{"AJointedHeap", Drive::kJointed, heap}),
                         [](const auto& scene) { return scene.param.name; });

TEST_P(CheckpointIn, SavingDoesNotChangeTheFutureAndRestoredWorldsShareIt) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const auto untouched = make(seed), saved = make(seed), restored = make(seed + 100);
    std::mt19937 random(seed);
    for (int piece = 0; piece < 20; ++piece) {
      const int steps = std::uniform_int_distribution<int>(1, 400)(random);
      const Hashes expected = goOn(untouched->world, steps, piece);
      ASSERT_EQ(goOn(saved->world, steps, piece), expected) << seed << " " << piece;
      if (piece > 0) {
        ASSERT_EQ(goOn(restored->world, steps, piece), expected) << seed << " " << piece;
      }
      const std::string bytes = saved->world.checkpoint();
      ASSERT_EQ(saved->world.stateHash(), untouched->world.stateHash());
      if (piece % 5 == 0) restored->world.restore(bytes);
      ASSERT_EQ(restored->world.stateHash(), untouched->world.stateHash());
    }
  }
}

TEST_P(CheckpointIn, AWayBackLeadsToWhatIsRestoredFromNothing) {
  for (unsigned seed = 1; seed <= 2; ++seed) {
    const auto w = make(seed);
    goOn(w->world, 700, seed);
    const std::string saved = w->world.checkpoint();
    w->world.restore(saved);
    for (unsigned way = 0; way < 3; ++way) {
      goOn(w->world, 400, 10 + way);
      if (way % 2) w->world.setState("kiva1", {Pose(-3, -4, 0, 0, 0, 1), {}});
      ASSERT_TRUE(returnTo(insideOf(w->world), saved)) << seed << " " << way;
      const auto fresh = make(seed + 100);
      fresh->world.restore(saved);
      ASSERT_TRUE(w->world.checkpoint() == saved) << seed << " " << way;
      ASSERT_EQ(goOn(w->world, 400, 20 + way), goOn(fresh->world, 400, 20 + way))
          << seed << " " << way;
      ASSERT_TRUE(w->world.checkpoint() == fresh->world.checkpoint()) << seed << " " << way;
    }
  }
}

TEST_F(Checkpoint, ThereIsNoWayBackToAnotherWorld) {
  goOn(w.world, 500, 1);
  const std::string saved = w.world.checkpoint();
  const Hashes first = goOn(w.world, 500, 2);
  const std::vector<std::function<void()>> changes = {
      [&] { w.spawn("kiva", "kiva77", 3, -2); },
      [&] { w.world.remove("storage_unit3"); },
      [&] {
        w.world.setState("conveyor_belt1", {Pose(3, -3, 0, 0, 0, 0), {}});
      },
      [&] {
        w.world.setGravity({0, 0, -5});
      },
      [&] { w.world.setStepSize(0.01); },
      [&] { w.world.restore(Warehouse(hall()).world.checkpoint()); },
  };
  EXPECT_FALSE(returnTo(insideOf(w.world), saved));
  for (std::size_t i = 0; i < changes.size(); ++i) {
    w.world.restore(saved);
    changes[i]();
    EXPECT_FALSE(returnTo(insideOf(w.world), saved)) << i;
    w.world.restore(saved);
    EXPECT_EQ(goOn(w.world, 500, 2), first) << i;
  }
}

TEST_F(Checkpoint, ModelsThatCameAndWentAreUndone) {
  const std::string saved = w.world.checkpoint();
  const std::vector<std::string> names = w.world.modelNames();
  const std::uint64_t revision = w.world.modelsRevision();
  w.world.remove("kiva2");
  w.world.remove("storage_unit3");
  w.spawn("kiva", "kiva77", 3, -2);
  w.world.restore(saved);
  EXPECT_EQ(w.world.modelNames(), names);
  EXPECT_GT(w.world.modelsRevision(), revision);
  EXPECT_LT(w.world.fleet().find(77), 0);
  w.spawn("kiva", "kiva77", 3, -2);
  w.movx(2, 1);
  w.runUntilIdle(2);
}

TEST_F(Checkpoint, PendingCommandsAndEventsAreKept) {
  w.forget();
  w.movx(3, 1);
  w.world.post(Command{Command::Kind::kMoveX, 99, 1});
  const std::string saved = w.world.checkpoint();
  Warehouse other{hall()};
  other.world.restore(saved);
  other.step();
  EXPECT_EQ(other.count(Event::Kind::kAccepted, "kiva3"), 1);
  EXPECT_EQ(other.count(Event::Kind::kRefused, "kiva99"), 1);
  w.world.step();  // events that were not taken yet
  other.forget();
  other.world.restore(w.world.checkpoint());
  other.collect();
  EXPECT_EQ(other.count(Event::Kind::kAccepted, "kiva3"), 1);
  EXPECT_EQ(other.count(Event::Kind::kRefused, "kiva99"), 1);
}

TEST_F(Checkpoint, DamagedBytesChangeNothing) {
  goOn(w.world, 500, 1);
  const std::string saved = w.world.checkpoint();
  const std::uint64_t hash = w.world.stateHash();
  std::mt19937 random(11);
  std::vector<std::string> bad{"", "KIVA", "KIVAWRLD", saved + "x", saved.substr(1)};
  for (int i = 0; i < 1000; ++i) {
    std::string bytes = saved;
    const std::size_t at = std::uniform_int_distribution<std::size_t>(0, saved.size() - 1)(random);
    if (i % 2) {
      bytes.resize(at);
    } else {
      bytes[at] ^= static_cast<char>(1 << (i / 2 % 8));
    }
    bad.push_back(bytes);
  }
  for (const std::string& bytes : bad) EXPECT_THROW(w.world.restore(bytes), CheckpointError);
  EXPECT_EQ(w.world.stateHash(), hash);
  EXPECT_TRUE(w.world.checkpoint() == saved);
}

/// Every checkpoint with a valid seal is refused with nothing changed, or gives a valid world.
TEST_P(CheckpointIn, NobodyWhoSealsItAgainBreaksTheWorld) {
  const auto w = make(1);
  std::vector<std::string> saved;
  for (int i = 0; i < 4; ++i) {
    goOn(w->world, 500, i);
    saved.push_back(w->world.checkpoint());
  }
  CheckpointDamager damaged(3);
  int refused = 0;
  for (int i = 0; i < 400; ++i) {
    refused += !restores(w->world, damaged(saved[i % saved.size()]), 5);
  }
  EXPECT_GT(refused, 200);
}

TEST_F(Checkpoint, TheFieldIsNamed) {
  const auto refusal = [&](const std::string& field, const std::string& why, auto value, auto to) {
    std::string bytes = w.world.checkpoint();
    const std::string from(reinterpret_cast<const char*>(&value), sizeof value);
    const std::size_t at = bytes.find(from, kContentAt);
    ASSERT_NE(at, std::string::npos) << field;
    bytes.replace(at, sizeof to, reinterpret_cast<const char*>(&to), sizeof to);
    try {
      w.world.restore(resealed(bytes));
      FAIL() << field;
    } catch (const CheckpointError& error) {
      EXPECT_PRED2(contains, error.what(), field);
      EXPECT_PRED2(contains, error.what(), why);
    }
  };
  const double nowhere = std::nan("");
  w.world.setGravity({0, 0, -9.625});
  refusal("gravity.Z", "number", -9.625, nowhere);
  const Wrench wrench{"box", "link", {1.0625, 0, 0}, {}, {0, 1}};
  w.world.apply(wrench);
  refusal("external_inputs.wrenches[0].force.X", "not nan", 1.0625, nowhere);
  w.world.post(Command{Command::Kind::kMoveX, 123456, 1});
  refusal("commands[0].kind", "77 is not one of its values",
          std::array<std::uint8_t, 5>{1, 0x40, 0xe2, 0x01, 0}, std::uint8_t{77});
}

TEST_F(Checkpoint, AnotherFormatIsNamed) {
  std::string saved = w.world.checkpoint();
  saved[8] = 99;
  try {
    w.world.restore(saved);
    FAIL();
  } catch (const CheckpointError& error) {
    EXPECT_PRED2(contains, error.what(), "format 99");
  }
}

TEST(CheckpointOfAHugeWarehouse, IsSmallAndQuick) {
  Floorplan plan;
  plan.size = 300;
  Warehouse w(plan);
  const auto place = [](int i) { return Pose(i % 100 - 50, i / 100 - 50, 0, 0, 0, 0); };
  const auto spawnAll = [&](const std::string& kind, int count, int first, double z) {
    const ModelInstance single = instance(modelText(kind), kind + "1");
    for (int i = 0; i < count; ++i) {
      Pose pose = place(first + i % 4000);
      pose.Pos().Z() = z;
      w.world.spawn({kind + std::to_string(i + 1), pose, single.description});
    }
  };
  spawnAll("storage_unit", 4000, 0, 0);
  spawnAll("item", 20000, 0, 0.8);
  spawnAll("kiva", 1000, 4000, 0);
  for (int id = 1; id <= 1000; ++id) w.movy(id, 3);
  w.run(1);
  w.forget();
  std::string saved;
  double seconds = 1;  // of this process alone, since others may be busy
  for (int i = 0; i < 5; ++i) {
    const std::clock_t begin = std::clock();
    saved = w.world.checkpoint();
    seconds = std::min(seconds, static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC);
  }
  EXPECT_LT(saved.size(), 5e6);
  std::printf("a checkpoint: %.0f ms, %.1f MB\n", 1e3 * seconds, saved.size() / 1e6);
  EXPECT_LT(seconds, 0.5);  // ten times what it takes
  const Hashes first = goOn(w.world, 100, 1);
  w.world.restore(saved);
  EXPECT_EQ(goOn(w.world, 100, 1), first);
}

}  // namespace
}  // namespace kiva::test
