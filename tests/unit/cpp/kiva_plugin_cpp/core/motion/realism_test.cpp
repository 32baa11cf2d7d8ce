// SPDX-License-Identifier: Apache-2.0
//
// Motors that lag, floors that are slippery in places, loads that tip, reports that are late.
#include <algorithm>
#include <cmath>
#include <functional>

#include "warehouse.h"

namespace kiva::test {
namespace {

using Kind = Event::Kind;

constexpr double kTopSpeed = 1.5;  // [m/s], of a Kiva

Floorplan planWith(const std::function<void(Realism&)>& change, const std::string& more = "") {
  Floorplan plan{60};
  plan.options.realism.emplace();
  change(*plan.options.realism);
  plan.more = more;
  return plan;
}

// --- motors

std::function<void(Realism&)> lagging(double seconds) {
  return [seconds](Realism& real) { real.actuation = {true, seconds, 0, 0}; };
}

/// Returns position and speed of a robot after each step of a drive of 10 m.
std::vector<std::pair<double, double>> drive(const Floorplan& plan, double seconds) {
  Warehouse w(plan);
  w.spawn("kiva", "kiva1", 0, 0);
  w.movx(1, 10);
  std::vector<std::pair<double, double>> way;
  for (double time = 0; time < seconds; time += 0.001) {
    w.world.step();
    way.emplace_back(w.x(1), w.speed(1));
  }
  return way;
}

TEST(MotorLag, IsOfFirstOrder) {
  const double lag = 0.1;
  const auto ideal = drive(planWith([](Realism&) {}), 10.5);
  const auto real = drive(planWith(lagging(lag)), 10.5);
  double speed = 0, error = 0;
  for (std::size_t i = 0; i < ideal.size(); ++i) {
    speed += (1 - std::exp(-0.001 / lag)) * (ideal[i].second - speed);
    error = std::max(error, std::abs(real[i].second - speed));
  }
  EXPECT_LT(error, 0.002);
  EXPECT_NEAR(ideal[4000].first - real[4000].first, lag * kTopSpeed, 0.002);
  EXPECT_NEAR(real.back().first, 10, 1e-5);
  EXPECT_LT(std::abs(real.back().second), 1e-6);
}

TEST(MotorLag, IsThatOfRobotsInBulletToo) {
  Floorplan bullet = planWith(lagging(0.05));
  bullet.options.always_in_bullet = true;
  const auto arrays = drive(planWith(lagging(0.05)), 9), all = drive(bullet, 9);
  double off = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    off = std::max(off, std::abs(arrays[i].first - all[i].first));
  }
  EXPECT_LT(off, 1e-4);
}

TEST(MotorLag, LeavesRoomToStopOnAPathThatEnds) {
  Warehouse w(planWith(lagging(0.2)));
  w.spawn("kiva", "kiva1", 0, 0);
  w.movx(1, 10);
  w.run(3);
  Command cancel;
  cancel.kind = Command::Kind::kCancel;
  cancel.kiva_id = 1;
  w.world.post(cancel);
  w.runUntilIdle(1);
  EXPECT_NEAR(w.x(1), std::round(w.x(1)), kMillimetre);
  EXPECT_LT(w.x(1), 7);
}

// --- floors

std::string patch(double friction, const std::string& centre = "5 0") {
  return "<plugin name='oil' filename='libkiva_floor_patch.so'><centre>" + centre +
         "</centre><size>4 2</size><friction>" + number(friction) + "</friction></plugin>";
}

/// Returns the stopping distance of a robot that is stopped at x = 4 at its top speed [m].
double stoppingWay(const std::string& more) {
  Warehouse w(planWith([](Realism&) {}, more));
  w.spawn("kiva", "kiva1", 0, 0);
  w.movx(1, 10);
  while (w.x(1) < 4) w.world.step();
  Command stop;
  stop.kind = Command::Kind::kStop;
  stop.kiva_id = 1;
  w.world.post(stop);
  const double here = w.x(1);
  while (w.world.fleet().vx[0] > 1e-4) w.world.step();
  return w.x(1) - here;
}

TEST(FloorPatch, LowersTheGripOfWheels) {
  const double emergency = 2.5;  // [m/s²]
  EXPECT_NEAR(stoppingWay(""), kTopSpeed * kTopSpeed / (2 * emergency), 0.01);
  // Its driven wheels bear 80 % of its weight: they hold no more.
  const double held = 0.05 * 0.8 * 9.81;
  EXPECT_NEAR(stoppingWay(patch(0.05)), kTopSpeed * kTopSpeed / (2 * held), 0.05);
}

TEST(FloorPatch, EndsAtItsEdgeAndLiesOnEarlierOnes) {
  const double dry = stoppingWay("");
  EXPECT_NEAR(stoppingWay(patch(0.05, "5 3")), dry, 1e-9);
  EXPECT_NEAR(stoppingWay(patch(0.05) + patch(1)), dry, 1e-9);
}

TEST(FloorPatch, IsRefusedIfItIsFaulty) {
  const auto complaint = [](const std::string& text) {
    const auto warnings = Warehouse(planWith([](Realism&) {}, text)).world.takeWarnings();
    return warnings.empty() ? "" : warnings.front();
  };
  EXPECT_PRED2(contains, complaint(patch(-1)), "from 0 to 10");
  EXPECT_PRED2(contains, complaint(replaced(patch(1), "4 2", "0 2")), "two lengths above 0");
  EXPECT_PRED2(contains, complaint(replaced(patch(1), "centre", "middle")), "'middle'");
}

TEST(FloorPatch, IsTurnedOnAsHardAsItGrips) {
  const auto localised = [](Realism& real) { real.localisation.enabled = true; };
  for (const double friction : {0.05, 0.15, 0.25}) {
    Warehouse w(planWith(localised, patch(friction, "0 0")));
    w.spawn("kiva", "kiva1", 0, 0);
    w.spawnText(unitOfMass(300), "storage_unit1", 0, 0);
    w.carry(1, 1);
    w.runUntilIdle(1);
    for (int quarters = 1; quarters <= 4; ++quarters) {
      w.rot(1, kLeft);
      w.runUntilIdle(1);
      EXPECT_NEAR(w.yaw(1), quarters * kQuarter, 0.02) << friction;
    }
    EXPECT_EQ(w.count(Kind::kBlocked), 0) << friction;
  }
}

/// Returns those of 64 robots that do not reach the next cell properly.
std::vector<int> whoSlides(double share, std::uint64_t seed) {
  Floorplan plan = planWith([share](Realism& real) { real.floor = {true, share, 0.05}; });
  plan.options.seed = seed;
  Warehouse w(plan);
  for (int i = 0; i < 64; ++i) {
    w.spawn("kiva", "kiva" + std::to_string(i + 1), 3 * (i % 8) - 12, 3 * (i / 8) - 12);
    w.movx(i + 1, 1);
  }
  w.run(2.5);
  std::vector<int> out;
  for (int i = 0; i < 64; ++i) {
    if (std::abs(w.x(i + 1) - (3 * (i % 8) - 11)) > 0.01) out.push_back(i);
  }
  return out;
}

TEST(SlipperyCells, AreDrawnByTheSeed) {
  const std::vector<int> some = whoSlides(0.2, 1);
  // Either of two cells of theirs: 64 (1 - 0.8²) of them.
  EXPECT_NEAR(static_cast<double>(some.size()), 23, 12);
  EXPECT_EQ(whoSlides(0.2, 1), some);
  EXPECT_NE(whoSlides(0.2, 2), some);
  EXPECT_TRUE(whoSlides(0, 1).empty());
}

// --- loads

/// A robot at its top speed with a unit whose centre of mass is that high above its underside.
class Loaded : public Warehouse {
 public:
  Loaded(double height, double tipping_share)
      : Warehouse(planWith([tipping_share](Realism& real) {
          real.loads = {true, tipping_share};
        })) {
    spawn("kiva", "kiva1", 0, 0);
    const std::string unit = replaced(modelText("storage_unit"), "<pose>0 0 1.0 0 0 0</pose>",
                                      "<pose>0 0 " + number(0.43 + height) + " 0 0 0</pose>");
    spawnText(unit, "storage_unit1", 0, 0);
    carry(1, 1);
    runUntilIdle(1);
    movx(1, 15);
    run(6);
    forget();
  }
  void stop() {
    Command command;
    command.kind = Command::Kind::kStop;
    command.kiva_id = 1;
    world.post(command);
  }
  double brake() {
    stop();
    const double here = x(1);
    run(4);
    return x(1) - here;
  }
  bool carries() const { return world.fleet().unit[0] >= 0; }
};

constexpr double kPlate = 0.25;  // [m], its radius

TEST(Load, IsBrakedSoThatItDoesNotTip) {
  Loaded w(1.6, 0.5);
  ASSERT_NEAR(w.speed(1), kTopSpeed, 1e-6);
  const double limit = 0.5 * 9.81 * kPlate / 1.6;
  EXPECT_NEAR(w.brake(), kTopSpeed * kTopSpeed / (2 * limit), 0.02);
  EXPECT_TRUE(w.carries());
  EXPECT_EQ(w.count(Kind::kTipped), 0);
}

TEST(Load, TipsIfItIsBrakedHarderThanItCanStand) {
  Loaded w(1.3, 100);
  ASSERT_NEAR(w.speed(1), kTopSpeed, 1e-6);
  w.stop();
  const auto up = [&] { return w.world.storageUnitPose(0).Rot().ZAxis(); };
  w.runUntil([&] { return up().Z() < 0.5; }, 5);  // it falls, or leans on its robot,
  EXPECT_GT(up().X(), 0.5);                       // forwards
  ASSERT_EQ(w.count(Kind::kTipped), 1);
  EXPECT_EQ(w.last(Kind::kTipped).model, "storage_unit1");
  EXPECT_EQ(w.last(Kind::kTipped).other, "kiva1");
  EXPECT_FALSE(w.carries());
}

TEST(Load, StandsIfItIsLow) {
  Loaded w(0.6, 100);  // tips from 4.1 m/s² on
  w.brake();
  EXPECT_TRUE(w.carries());
  EXPECT_EQ(w.count(Kind::kTipped), 0);
}

TEST(Load, TipsTheSameFromACheckpointOn) {
  Loaded w(1.3, 100);
  w.stop();
  w.run(0.3);  // it leans by now
  World other{WorldDescription()};
  other.restore(w.world.checkpoint());
  EXPECT_EQ(w.count(Kind::kTipped), 0);
  for (int i = 0; i < 2000; ++i) {
    w.run(0.001);
    other.step();
  }
  EXPECT_EQ(w.count(Kind::kTipped), 1);
  EXPECT_EQ(other.stateHash(), w.world.stateHash());
}

// --- localisation

/// Returns the time of ten drives of a metre each [s].
double timeOfStops(const Floorplan& plan) {
  Warehouse w(plan);
  w.spawn("kiva", "kiva1", 0, 0);
  for (int metre = 1; metre <= 10; ++metre) {
    w.movx(1, metre);
    w.runUntilIdle(1);
  }
  return w.world.time();
}

TEST(Localisation, DoesNotKeepARobotFromStopping) {
  const double ideal = timeOfStops(planWith([](Realism&) {}));
  const double real = timeOfStops(planWith([](Realism& r) { r.localisation.enabled = true; }));
  EXPECT_NEAR(real, ideal, 10 * 0.15);
}

// --- reports

Floorplan lateReports(double least, double mean, double lost) {
  return planWith([=](Realism& real) {
    RadioRealism& radio = real.radio;
    radio.enabled = true;
    radio.latency_least = radio.latency_mean = radio.lost = radio.repeated = 0;
    radio.status_latency_least = least;
    radio.status_latency_mean = mean;
    radio.status_lost = lost;
  });
}

TEST(Reports, ComeLate) {
  Warehouse w(lateReports(0.2, 0.3, 0.3));
  w.spawn("kiva", "kiva1", 0, 0);
  w.run(0.002);
  ASSERT_TRUE(w.world.lastHeard(0));
  EXPECT_EQ(w.world.lastHeard(0)->x, 0);  // the caller put it there
  w.movx(1, 20);
  w.run(0.19);
  EXPECT_EQ(w.world.lastHeard(0)->x, 0);
  w.run(3);
  double before = 0, sum = 0, least = 10;
  for (int i = 0; i < 400; ++i) {
    w.run(0.02);
    const double heard = w.world.lastHeard(0)->x, late = (w.x(1) - heard) / kTopSpeed;
    EXPECT_GE(heard, before);  // a report that was overtaken is dropped
    before = heard;
    least = std::min(least, late);
    sum += late;
  }
  // A tenth of a second between two, of which some are lost, beside the latency.
  EXPECT_GE(least, 0.2 - 1e-6);
  EXPECT_NEAR(sum / 400, 0.36, 0.08);
}

TEST(Reports, TellEachStatusWhenItIsHeard) {
  Warehouse w(lateReports(0.5, 0.5, 0));
  w.spawn("kiva", "kiva1", 0, 0);
  w.run(1);
  w.changes.clear();
  w.rot(1, kLeft);
  w.run(0.45);
  EXPECT_TRUE(w.changes.empty());
  w.run(2);
  ASSERT_EQ(w.changes.size(), 2u);
  EXPECT_EQ(w.changes[0].state, State::kRotating);
  EXPECT_EQ(w.changes[1].status, Status::kIdle);
  EXPECT_NEAR(w.changes[0].time, 1.5, 0.01);
}

TEST(Reports, GoOnFromACheckpoint) {
  Warehouse w(lateReports(0.05, 0.3, 0.2));
  w.spawn("kiva", "kiva1", 0, 0);
  w.movx(1, 5);
  w.run(1.23);
  World other{WorldDescription()};
  other.restore(w.world.checkpoint());
  for (int i = 0; i < 3000; ++i) {
    other.step();
    w.world.step();
    ASSERT_EQ(other.lastHeard(0)->x, w.world.lastHeard(0)->x);
  }
  EXPECT_EQ(other.stateHash(), w.world.stateHash());
}

// --- motion

TEST(MeasuredMotion, IsThatOfRobotsAsFarAsItWasMeasured) {
  Floorplan plan = planWith([](Realism& real) { real.motion = {true, 0.8, 0.5, 0, 4}; });
  Warehouse w(plan);
  w.spawn("kiva", "kiva1", 0, 0);
  w.movx(1, 8);
  w.run(1);
  EXPECT_NEAR(w.speed(1), 0.5, 0.002);
  w.run(4);
  EXPECT_NEAR(w.speed(1), 0.8, 0.002);
  const Robot& robot = w.world.fleet().robots[0];
  EXPECT_EQ(robot.lift.time, 4);
  EXPECT_EQ(robot.drive.quarter_turn_time, 0.625);
}

}  // namespace
}  // namespace kiva::test
