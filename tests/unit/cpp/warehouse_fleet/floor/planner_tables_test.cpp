// SPDX-License-Identifier: Apache-2.0
//
// Distance tables: made on demand, and renewed as traffic changes the costs of edges.
#include <vector>

#include "core/floor/distance_tables.h"
#include "planner_shift.h"

namespace fleet::test {
namespace {

constexpr int kGoals = 10, kAge = 3, kWidth = 20, kStates = kWidth * kHeadings;

class Tables : public testing::Test {
 protected:
  /// Sets the cost of each edge to `ticks`.
  void price(int ticks) {
    costs_.assign(costs_.size(), static_cast<std::uint8_t>(ticks * kTickCost));
    tables_.reprice();
  }

  /// Steps with a need for all tables; renews `least` states of them at least. Returns each goal's
  /// distance from the far end [ticks].
  std::vector<int> step(int urgent = -1, int least = 0) {
    tables_.begin(++now_, 0, kGoals * kStates);
    for (int goal = 0; goal < kGoals; ++goal) tables_.need(Deck::kUnder, goal);
    tables_.make();
    std::vector<int> ticks;
    for (int goal = 0; goal < kGoals; ++goal) {
      const DistanceTable* table = tables_.find(Deck::kUnder, 0, goal, goal == urgent);
      ticks.push_back(table->at(kWidth - 1, 2) / kTickCost);
    }
    tables_.renew(kAge, kStates, least);
    return ticks;
  }

  const Floor floor_{drawn({std::string(kWidth, '.')})};
  std::vector<std::uint8_t> costs_ = std::vector<std::uint8_t>(kWidth * kHeadings, kTickCost);
  const std::vector<Cell>& next_ = floor_.edges(Deck::kUnder);
  Edges edges_{{next_, next_}, &costs_, {}};
  const Threads threads_{1};
  DistanceTables tables_{floor_, edges_, {1, std::size_t{1} << 20, kWidth}, threads_};
  int now_ = 0;
};

TEST_F(Tables, AllAreMadeAnewInTurn) {
  step();
  price(2);
  for (int tick = 0; tick < kAge + kGoals; ++tick) step();
  const std::vector<int> ticks = step();
  for (int goal = 0; goal < kGoals; ++goal) EXPECT_EQ(ticks[goal], 2 * (kWidth - 1 - goal));
}

TEST_F(Tables, WhoDoesNotGetOnComesFirst) {
  for (int tick = 0; tick < kAge; ++tick) step();
  price(2);
  step(7);
  const std::vector<int> ticks = step();
  for (int goal = 0; goal < kGoals; ++goal) {
    EXPECT_EQ(ticks[goal], (goal == 7 ? 2 : 1) * (kWidth - 1 - goal));
  }
}

TEST_F(Tables, AsManyAreRenewedAsAreAlwaysAllowed) {
  constexpr int kThree = 3;
  for (int tick = 0; tick < kAge; ++tick) step();
  price(2);
  step(-1, kThree * kStates);
  const std::vector<int> ticks = step();
  int renewed = 0;
  for (int goal = 0; goal < kGoals; ++goal) renewed += ticks[goal] == 2 * (kWidth - 1 - goal);
  EXPECT_EQ(renewed, kThree);
}

}  // namespace
}  // namespace fleet::test
