// SPDX-License-Identifier: Apache-2.0
//
// Robots that touch: real contact, reported once, after which all robots return to the grid.
#include <array>
#include <map>
#include <random>
#include <set>
#include <utility>
#include <vector>

#include "core/geometry/obstacles.h"
#include "warehouse.h"

namespace kiva::test {
namespace {

constexpr double kLength = 0.76, kWidth = 0.64;  // of a Kiva [m]

Footprint footprintOf(const Fleet& f, int i) {
  Shape body;
  body.size.Set(kLength, kWidth, 0.4);
  return makeFootprint(body, Pose(f.x[i], f.y[i], 0.2, 0, 0, f.yaw[i]));
}

/// Returns the largest overlap of any two robots [m]; negative while all are apart.
double overlap(const Fleet& f) {
  double most = -1e9;
  for (int i = 0; i < f.size(); ++i) {
    for (int j = i + 1; j < f.size(); ++j) {
      if (std::hypot(f.x[i] - f.x[j], f.y[i] - f.y[j]) > 1) continue;
      most = std::max(most, -gap(footprintOf(f, i), footprintOf(f, j)));
    }
  }
  return most;
}

/// A robot that drives into the side of another which had no time to see it.
struct SideHit {
  SideHit() {
    w.spawnText(withoutPlugin(modelText("kiva"), "laser"), "kiva1", 0, 0);
    w.spawn("kiva", "kiva2", 5, 0, kQuarter);
    w.movx(1, 10);
  }
  Warehouse w;
};

TEST(Collision, IsToldOnceWithBothNames) {
  SideHit hit;
  hit.w.run(20);
  ASSERT_EQ(hit.w.count(Event::Kind::kCollision), 1);
  const Event event = hit.w.last(Event::Kind::kCollision);
  EXPECT_EQ(std::set<std::string>({event.model, event.other}),
            std::set<std::string>({"kiva1", "kiva2"}));
}

TEST(Collision, StopsBothAndEndsTheCommand) {
  SideHit hit;
  hit.w.run(20);
  EXPECT_EQ(hit.w.count(Event::Kind::kBlocked, "kiva1"), 1);
  EXPECT_EQ(hit.w.status(1), Status::kIdle);
  EXPECT_EQ(hit.w.speed(1), 0);
  EXPECT_EQ(hit.w.speed(2), 0);
}

TEST(Collision, PushesTheOneThatIsHit) {
  SideHit hit;
  hit.w.run(20);
  EXPECT_GT(hit.w.offGrid(2), 0.01);
}

TEST(Collision, LetsNothingPassThrough) {
  SideHit hit;
  double worst = -1;
  hit.w.run(20, [&] { worst = std::max(worst, overlap(hit.w.world.fleet())); });
  EXPECT_GT(worst, -kMillimetre) << "they never met";
  EXPECT_LT(worst, kMillimetre);
}

TEST(Collision, ConservesMomentumInTheImpact) {
  SideHit hit;
  double before = 0;
  while (hit.w.world.fleet().vx[1] == 0) {
    before = hit.w.world.fleet().vx[0];
    hit.w.step();
  }
  const Fleet& f = hit.w.world.fleet();
  // Equal masses; the floor's friction has had one step to act, at most mu·g·dt on each.
  EXPECT_NEAR(f.vx[0] + f.vx[1], before, 2 * 0.8 * 9.81 * 0.001 + 1e-6);
}

TEST(Collision, APushedRobotReturnsToTheGridBeforeItsNextCommand) {
  SideHit hit;
  hit.w.run(20);
  hit.w.movy(2, 3);
  hit.w.runUntilIdle(2);
  hit.w.expectOnGrid(2);
  EXPECT_EQ(hit.w.count(Event::Kind::kDone, "kiva2"), 1);
  hit.w.movx(1, -2);
  hit.w.runUntilIdle(1);
  hit.w.expectOnGrid(1);
}

TEST(Collision, WithAStandingUnitPushesIt) {
  Warehouse w;
  w.spawn("storage_unit", "storage_unit1", 0, 0);
  w.spawn("storage_unit", "storage_unit2", 5, 0);
  w.spawnText(withoutPlugin(modelText("kiva"), "laser"), "kiva1", 0, 0);
  w.carry(1, 1);
  w.runUntilIdle(1);
  w.movx(1, 10);
  w.run(15);
  EXPECT_EQ(w.count(Event::Kind::kCollision), 1);
  EXPECT_GT(w.unitPose(2).X(), 5.001);
  EXPECT_NEAR(w.unitPose(2).Z(), 0, kMillimetre);
}

TEST(Collision, ABoxThatFallsOnARobotsWayIsSeenAndOneOnItsHeadIsFelt) {
  const std::string box =
      "<sdf version='1.9'><model name='box'><link name='l'><inertial><mass>5</mass><inertia>"
      "<ixx>0.08</ixx><iyy>0.08</iyy><izz>0.08</izz></inertia></inertial><collision name='c'>"
      "<geometry><box><size>0.45 0.45 "
      "0.45</size></box></geometry></collision></link></model></sdf>";
  Warehouse w;
  w.spawn("kiva", "kiva1", 0, 0);
  w.spawnText(box, "box1", 6, 0, 0, 1.0);
  w.movx(1, 10);
  w.runUntilIdle(1);
  w.expectAt(1, 5, 0);
  EXPECT_EQ(w.last(Event::Kind::kBlocked).other, "box1");

  w.spawnText(box, "box2", 5, 0, 0, 1.0);
  w.run(2);
  EXPECT_EQ(w.last(Event::Kind::kCollision).other, "box2");
  EXPECT_NEAR(w.world.state("box2")->pose.Z(), 0.4 + 0.225, 0.002);
}

// --- impulses

class SlowImpact : public ::testing::TestWithParam<double> {};

TEST_P(SlowImpact, TellsWhatStopsTheImpactAndNotThePushThatGoesOn) {
  const double speed = GetParam();
  Warehouse w;
  const std::string blind = withoutPlugin(kivaText({{"speed", std::to_string(speed)}}), "laser");
  w.spawnText(blind, "kiva1", 0, 0);
  w.spawn("kiva", "kiva2", 2, 0, kQuarter);
  w.movx(1, 10);
  w.run(1.3 / speed + 2);
  ASSERT_EQ(w.count(Event::Kind::kCollision), 1);
  const Impact impact = w.last(Event::Kind::kCollision).impact;
  EXPECT_NEAR(impact.speed, speed, 0.01 * speed);
  EXPECT_NEAR(impact.impulse, 145 * speed / 2, 0.03 * 145 * speed / 2);  // plastic, equal masses
}
INSTANTIATE_TEST_SUITE_P(Speeds, SlowImpact, ::testing::Values(0.05, 0.1, 0.2, 0.5));

// --- what falls

struct Fall {
  const char* onto;
  double x, y, top;  // where it falls, and on what height [m]
};

class FallingBox : public ::testing::TestWithParam<Fall> {};

TEST_P(FallingBox, IsForeseenByWhatStandsBelow) {
  const Fall& fall = GetParam();
  constexpr double kHalf = 0.1, kMass = 5;
  Warehouse w;
  w.spawn(fall.onto, std::string(fall.onto) + "1", 0, 0);
  w.spawnText(
      "<sdf version='1.9'><model name='box'><link name='l'><inertial><mass>5</mass>"
      "<inertia><ixx>0.033</ixx><iyy>0.033</iyy><izz>0.033</izz></inertia></inertial>"
      "<collision name='c'><geometry><box><size>0.2 0.2 0.2</size></box></geometry>"
      "</collision></link></model></sdf>",
      "box", fall.x, fall.y, 0, fall.top + kHalf + 1);
  double lowest = 1e9, rebound = 0;
  bool landed = false;
  w.run(1.5, [&] {
    const EntityState box = *w.world.state("box");
    lowest = std::min(lowest, box.pose.Z());
    landed = landed || box.pose.Z() < fall.top + kHalf + kMillimetre;
    if (landed) rebound = std::max(rebound, box.twist.linear.Z());
  });
  ASSERT_EQ(w.count(Event::Kind::kCollision), 1);
  const double expected = kMass * std::sqrt(2 * 9.81 * 1);
  EXPECT_NEAR(w.last(Event::Kind::kCollision).impact.impulse, expected, 0.02 * expected);
  EXPECT_GT(lowest, fall.top + kHalf - kMillimetre);
  EXPECT_LT(rebound, 0.02);
  EXPECT_NEAR(w.world.state("box")->pose.X(), fall.x, 0.005);
  EXPECT_NEAR(w.world.state("box")->pose.Z(), fall.top + kHalf, kMillimetre);
}
INSTANTIATE_TEST_SUITE_P(Onto, FallingBox,
                         ::testing::Values(Fall{"kiva", 0.02, 0, 0.4},
                                           Fall{"storage_unit", 0.1, 0, 1.8}),
                         [](const auto& info) { return info.param.onto; });

class AgainstAWall : public ::testing::TestWithParam<const char*> {};

TEST_P(AgainstAWall, StallsOrSlipsAndDoesNotPass) {
  for (const char* drive : {"traction", "jointed"}) {
    Warehouse w;
    const std::string blind = withoutPlugin(
        kivaText({{"speed", GetParam()}, {"drive", drive}, {"acceleration", "3"}}), "laser");
    w.spawnText(blind, "kiva1", 0, 0);
    w.spawn("wall", "wall1", 8.1, 0, kQuarter);  // its face is at x = 8
    double front = 0, fastest = 0;
    w.movx(1, 20);
    w.run(25, [&] {
      front = std::max(front, w.x(1) + kLength / 2);
      fastest = std::max(fastest, w.speed(1));
    });
    EXPECT_GT(fastest, std::stod(GetParam()) - 0.05) << drive;
    EXPECT_GT(front, 8 - 0.005) << drive;
    EXPECT_LT(front, 8 + kMillimetre) << drive;
    EXPECT_EQ(w.count(Event::Kind::kCollision), 1) << drive;
    EXPECT_EQ(w.count(Event::Kind::kBlocked), 1) << drive;
  }
}
INSTANTIATE_TEST_SUITE_P(Speeds, AgainstAWall, ::testing::Values("0.5", "1.5", "2.2", "3"));

/// Ten simulated minutes of random commands to twenty robots in a hall.
class CrowdedHall {
 public:
  explicit CrowdedHall(unsigned seed) : w_("hall.sdf"), random_(seed) {
    std::set<std::pair<int, int>> taken;
    while (static_cast<int>(taken.size()) < kRobots) {
      const int x = cell(), y = cell();
      if (!taken.insert({x, y}).second) continue;
      w_.spawn("kiva", "kiva" + std::to_string(taken.size()), x, y, kQuarter * (random_() % 4));
    }
  }

  void run() {
    w_.run(600, [this] {
      for (int id = 1; id <= kRobots; ++id) command(id);
      watch();
    });
    w_.runUntil([this] { return allIdle(); }, 120, [this] { watch(); });
  }

  double worst_overlap = -1;        ///< [m]
  int unreported = 0;               ///< Contacts without their event.
  double longest_busy = 0;          ///< [s]
  std::map<std::string, int> open;  ///< Accepted commands without an end, by robot.
  int commands = 0, collisions = 0;

 private:
  static constexpr int kRobots = 20;
  using Pair = std::pair<int, int>;

  int cell() { return static_cast<int>(random_() % 11) - 5; }

  void command(int id) {
    if (w_.status(id) != Status::kIdle || random_() % 200 != 0) return;
    const int kind = static_cast<int>(random_() % 4);
    if (kind == 0) w_.mov(id, cell(), cell());
    if (kind == 1) w_.movx(id, cell());
    if (kind == 2) w_.movy(id, cell());
    if (kind == 3) w_.rot(id, random_() % 2 ? kLeft : kRight);
  }

  bool allIdle() const {
    for (int id = 1; id <= kRobots; ++id) {
      if (w_.status(id) != Status::kIdle) return false;
    }
    return true;
  }

  void watch() {
    takeEvents();
    const Fleet& f = w_.world.fleet();
    for (int i = 0; i < f.size(); ++i) {
      busy_[i] = f.status[i] == Status::kIdle ? 0 : busy_[i] + w_.world.stepSize();
      longest_busy = std::max(longest_busy, busy_[i]);
    }
    if (steps_++ % 20 == 0) findNeighbours(f);
    for (const auto& [i, j] : neighbours_) checkPair(f, i, j);
  }

  /// Collects pairs that may come within a metre in the next twenty steps, at 2.5 m/s each.
  void findNeighbours(const Fleet& f) {
    neighbours_.clear();
    for (int i = 0; i < f.size(); ++i) {
      for (int j = i + 1; j < f.size(); ++j) {
        if (std::hypot(f.x[i] - f.x[j], f.y[i] - f.y[j]) < 1.1) neighbours_.emplace_back(i, j);
      }
    }
  }

  /// Two that overlap must have been reported when their impact was over.
  void checkPair(const Fleet& f, int i, int j) {
    const bool near = std::hypot(f.x[i] - f.x[j], f.y[i] - f.y[j]) < 1;
    const double apart = near ? gap(footprintOf(f, i), footprintOf(f, j)) : 1;
    worst_overlap = std::max(worst_overlap, -apart);
    const Pair pair{i + 1, j + 1};
    if (apart > kMillimetre) {
      reported_.erase(pair);
      touched_.erase(pair);
    } else if (apart < -1e-6 && !reported_.count(pair) && ++touched_[pair] == 12) {
      ++unreported;
    }
  }

  void takeEvents() {
    for (const Event& e : w_.events) {
      if (e.kind == Event::Kind::kAccepted) ++open[e.model], ++commands;
      if (e.kind == Event::Kind::kDone || e.kind == Event::Kind::kBlocked) --open[e.model];
      if (e.kind != Event::Kind::kCollision) continue;
      ++collisions;
      if (e.model.rfind("kiva", 0) || e.other.rfind("kiva", 0)) continue;
      const int a = std::stoi(e.model.substr(4)), b = std::stoi(e.other.substr(4));
      reported_.insert({std::min(a, b), std::max(a, b)});
    }
    w_.forget();
  }

  Warehouse w_;
  std::mt19937 random_;
  std::array<double, kRobots> busy_{};
  std::vector<Pair> neighbours_;  ///< Their indices.
  int steps_ = 0;
  std::set<Pair> reported_;
  std::map<Pair, int> touched_;
};

class TenMinutesInACrowdedHall : public ::testing::TestWithParam<unsigned> {};

TEST_P(TenMinutesInACrowdedHall, EveryContactIsToldAndEveryCommandEnds) {
  CrowdedHall hall(GetParam());
  hall.run();
  EXPECT_LT(hall.worst_overlap, kMillimetre);
  EXPECT_EQ(hall.unreported, 0);
  EXPECT_LT(hall.longest_busy, 60);
  EXPECT_GT(hall.commands, 1000);
  EXPECT_GT(hall.collisions, 10);
  for (const auto& [robot, count] : hall.open) EXPECT_EQ(count, 0) << robot;
}
INSTANTIATE_TEST_SUITE_P(Seeds, TenMinutesInACrowdedHall, ::testing::Values(1u, 2u, 3u));

}  // namespace
}  // namespace kiva::test
