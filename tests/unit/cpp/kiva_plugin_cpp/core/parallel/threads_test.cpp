// SPDX-License-Identifier: Apache-2.0
//
// A world is the same for any number of threads.
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <ctime>
#include <random>
#include <stdexcept>
#include <thread>

#include "core/parallel/step_trial.h"
#include "core/parallel/workers.h"
#include "core/state/world_state.h"
#include "warehouse.h"

namespace kiva::test {
namespace {

constexpr int kRobots = 20, kUnits = 160;  // as in the preset `medium`
constexpr double kTime = 60;               // [s]

/// Robots, a third of them without a laser, and units close to one another, and random commands:
/// many end in collisions. Lasers scan every other step: of ten scans a second there would be none
/// to share.
class Crowd {
 public:
  explicit Crowd(int threads) : w(plan(threads)) {
    if (threads > 1) insideOf(w.world).schedule.workers->shareAll();
    for (int i = 0; i < kUnits; ++i) {
      w.spawn("storage_unit", "storage_unit" + std::to_string(i + 1), i % 16 - 8, i / 16 - 5);
    }
    const std::string sees = kivaText({{"rate", "100"}}), blind = withoutPlugin(sees, "laser");
    for (int i = 0; i < kRobots; ++i) {  // each under a unit, and commanded to carry that
      const int unit = 8 * i;
      w.spawnText(i % 3 ? sees : blind, "kiva" + std::to_string(i + 1), unit % 16 - 8,
                  unit / 16 - 5);
      if (i % 2) w.carry(i + 1, unit + 1);
    }
  }

  /// Returns the hash of the state and of all scans after the whole run.
  std::uint64_t run() {
    std::uint64_t hash = 0;
    std::vector<std::vector<float>> ranges;
    for (int command = 0; command < kTime * 10; ++command) {
      post();
      w.run(0.1, [&] {
        w.world.scan(w.world.scansDue(), &ranges);
        for (const auto& scan : ranges) {
          for (float range : scan) hash = 31 * hash + std::hash<float>()(range);
        }
      });
    }
    return hash ^ w.world.stateHash();
  }

  Warehouse w;

 private:
  static Floorplan plan(int threads) {
    Floorplan plan;
    plan.size = 24;
    plan.step = 0.005;
    plan.options.threads = threads;
    return plan;
  }
  int uniform(int from, int to) { return std::uniform_int_distribution<int>(from, to)(random_); }
  void post() {
    const int id = uniform(1, kRobots);
    switch (uniform(0, 4)) {
      case 0:
        return w.rot(id, uniform(0, 1) ? 1 : -1);
      case 1:
        return w.movx(id, uniform(-5, 5));
      case 2:
        return w.movy(id, uniform(-5, 5));
      case 3:
        return w.carry(id, uniform(1, kUnits));
      default:
        return w.mov(id, uniform(-8, 8), uniform(-6, 6));
    }
  }

  std::mt19937 random_{3};
};

TEST(Threads, ChangeNothingInACrowd) {
  Crowd single(1);
  const std::uint64_t expected = single.run();
  EXPECT_GT(single.w.count(Event::Kind::kCollision), 10);
  EXPECT_GT(single.w.count(Event::Kind::kDone), 50);
  EXPECT_GT(single.w.count(Event::Kind::kBlocked), 10);
  for (const int threads : {2, 3, 8}) EXPECT_EQ(Crowd(threads).run(), expected) << threads;
}

TEST(Threads, TakeEachTurnOnce) {
  Workers workers(3);
  std::vector<std::atomic<int>> turns(1000);
  for (int round = 1; round <= 200; ++round) {
    workers.share(static_cast<int>(turns.size()), 7, [&](int begin, int end) {
      for (int k = begin; k < end; ++k) ++turns[k];
    });
    for (const auto& times : turns) ASSERT_EQ(times, round);
  }
}

/// A thread that is held up in its first turn keeps only that turn.
TEST(Threads, TakeOverWhatOthersDoNotComeTo) {
  constexpr int kTurns = 100;
  Workers workers(2);
  std::atomic<int> others{0};
  workers.share(kTurns, 1, [&](int begin, int) {
    if (begin > 0) {
      ++others;
      return;
    }
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (others < kTurns - 1 && std::chrono::steady_clock::now() < deadline) {
      std::this_thread::yield();
    }
    EXPECT_EQ(others, kTurns - 1);
  });
}

/// Returns the processor time of the whole process [s].
double cpuTime() { return static_cast<double>(std::clock()) / CLOCKS_PER_SEC; }

TEST(Threads, CostNothingWhileTheyWait) {
  Workers workers(8);
  std::atomic<int> turns{0};
  workers.share(1000, 1, [&](int, int) { ++turns; });
  EXPECT_EQ(turns, 1000);
  const double before = cpuTime();
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  EXPECT_LT(cpuTime() - before, 0.02);
}

TEST(Threads, HandOnWhatIsThrownWhenAllIsDone) {
  for (const unsigned threads : {1u, 3u}) {
    Workers workers(threads);
    std::atomic<int> done{0};
    const auto loop = [&](int begin, int) {
      ++done;
      if (begin == 5) throw std::runtime_error("the fifth");
    };
    EXPECT_THROW(workers.share(20, 1, loop), std::runtime_error) << threads;
    EXPECT_EQ(done, 20) << threads;
    EXPECT_NO_THROW(workers.share(5, 1, loop)) << threads;
  }
}

void spin(std::chrono::microseconds time) {
  const auto end = std::chrono::steady_clock::now() + time;
  while (std::chrono::steady_clock::now() < end) continue;
}

/// Returns whether loops are shared after a trial with these durations of a step, alone and shared
/// [µs].
bool sharesAfterTrial(int alone, int shared) {
  StepTrial trial;
  for (int step = 0; step < StepTrial::kFirst + StepTrial::kSteps; ++step) {
    trial.beginStep();
    if (step >= StepTrial::kFirst) spin(std::chrono::microseconds(trial.shares() ? shared : alone));
    trial.endStep();
  }
  return trial.shares();
}

TEST(Threads, TakePartInStepsThatAreQuickerByIt) {
  EXPECT_TRUE(sharesAfterTrial(200, 110));
  EXPECT_FALSE(sharesAfterTrial(200, 180));
  EXPECT_FALSE(sharesAfterTrial(100, 200));
}

TEST(Threads, AreTriedAgain) {
  StepTrial trial;
  const auto go = [&](int steps, int alone, int shared) {
    for (int step = 0; step < steps; ++step) {
      trial.beginStep();
      spin(std::chrono::microseconds(trial.shares() ? shared : alone));
      trial.endStep();
    }
  };
  go(StepTrial::kFirst, 0, 0);
  go(StepTrial::kSteps, 50, 100);
  EXPECT_FALSE(trial.shares());
  go(StepTrial::kBetween, 0, 0);
  go(StepTrial::kSteps, 100, 50);
  EXPECT_TRUE(trial.shares());
}

/// Where the parent's threads are gone.
TEST(Threads, WorkInAForkedChild) {
  Workers workers(3);
  const auto sum = [&] {
    std::atomic<int> all{0};
    workers.share(100, 1, [&](int begin, int) { all += begin; });
    return all.load();
  };
  EXPECT_EQ(sum(), 4950);
  const pid_t child = fork();
  if (child == 0) {
    alarm(20);
    _exit(sum() == 4950 ? 0 : 1);
  }
  int status = -1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(sum(), 4950);
}

TEST(Threads, AreOfANumberThatThereCanBe) {
  Floorplan plan;
  for (const int threads : {0, -1, 257}) {
    plan.options.threads = threads;
    EXPECT_THROW(Warehouse w(plan), std::invalid_argument) << threads;
  }
}

}  // namespace
}  // namespace kiva::test
