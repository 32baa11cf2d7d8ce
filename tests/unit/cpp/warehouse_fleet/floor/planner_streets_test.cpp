// SPDX-License-Identifier: Apache-2.0
//
// Narrow streets have directions in turn, and to drive against them costs more from the first tick.
#include "core/floor/guidance.h"
#include "core/floor/streets.h"
#include "planner_shift.h"

namespace fleet::test {
namespace {

constexpr int kEast = 0, kNorth = 1, kWest = 2, kSouth = 3;

/// Three streets between four shelves, in a hall that is two cells wide on each side.
const std::string kOpen(18, '.'), kShelf = "..##############..";
const std::vector<std::string> kHall = {kOpen,  kOpen, kShelf, kOpen, kShelf, kOpen,
                                        kShelf, kOpen, kShelf, kOpen, kOpen};
constexpr int kFirst = 3, kSecond = 5, kThird = 7;  // rows

class Streets : public testing::Test {
 protected:
  StreetWay way(int x, int y, int heading) const { return ways_[edge(x, y, heading)]; }

  int edge(int x, int y, int heading) const {
    return (y * floor_.width() + x) * kHeadings + heading;
  }

  const Floor floor_{drawn(kHall)};
  const std::vector<StreetWay> ways_ = streetWays(floor_);
};

TEST_F(Streets, HaveOppositeDirectionsInTurn) {
  for (int x = 0; x < floor_.width(); ++x) {
    for (const int row : {kFirst, kThird}) {
      EXPECT_EQ(way(x, row, kEast), StreetWay::kAlong) << x;
      EXPECT_EQ(way(x, row, kWest), StreetWay::kAgainst) << x;
    }
    EXPECT_EQ(way(x, kSecond, kWest), StreetWay::kAlong) << x;
    EXPECT_EQ(way(x, kSecond, kEast), StreetWay::kAgainst) << x;
  }
}

TEST_F(Streets, AreNarrow) {
  for (const int heading : {kEast, kWest}) {
    EXPECT_EQ(way(5, 1, heading), StreetWay::kNone);  // in the open hall
  }
  for (int y = 0; y < floor_.height(); ++y) {
    for (const int heading : {kNorth, kSouth}) EXPECT_EQ(way(0, y, heading), StreetWay::kNone) << y;
  }
}

TEST_F(Streets, AreLong) {
  std::vector<std::string> rows;
  for (const std::string& row : kHall) rows.push_back(row.substr(3));  // 15 cells
  for (const StreetWay way : streetWays(Floor(drawn(rows)))) EXPECT_EQ(way, StreetWay::kNone);
}

TEST_F(Streets, CostMoreAgainstTheirDirectionFromTheFirstTick) {
  GuidanceOptions options;
  options.streets = 1;
  Guidance guidance(floor_, options);
  for (int tick = 0; tick < 2; ++tick) {
    EXPECT_EQ(guidance.costs()[edge(5, kFirst, kWest)], 2 * kTickCost);
    EXPECT_EQ(guidance.costs()[edge(5, kFirst, kEast)], kTickCost);
    guidance.tick();
    guidance.refresh(0);
  }
}

TEST_F(Streets, AreAvoidedLessForTheirTraffic) {
  GuidanceOptions options;
  options.crowd = 10;
  options.memory = 1;
  for (const double streets : {0, 1}) {
    options.streets = streets;
    Guidance guidance(floor_, options);
    guidance.waited(kFirst * floor_.width() + 5);
    guidance.refresh(0);
    const int learnt = guidance.costs()[edge(4, kFirst, kEast)] - kTickCost;
    EXPECT_EQ(learnt, streets == 0 ? kMaxEdgeCost - kTickCost : 18) << streets;
  }
}

}  // namespace
}  // namespace fleet::test
