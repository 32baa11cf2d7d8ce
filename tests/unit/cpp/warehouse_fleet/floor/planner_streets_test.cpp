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
const std::vector<std::string> kHall = {
    "............", "............", "..########..", "............", "..########..", "............",
    "..########..", "............", "..########..", "............", "............"};
constexpr int kFirst = 3, kSecond = 5, kThird = 7;  // rows

class Streets : public testing::Test {
 protected:
  bool isAgainst(int x, int y, int heading) const {
    return against_[(y * floor_.width() + x) * kHeadings + heading] != 0;
  }

  const Floor floor_{drawn(kHall)};
  const std::vector<std::uint8_t> against_ = againstStreets(floor_);
};

TEST_F(Streets, HaveOppositeDirectionsInTurn) {
  for (int x = 0; x < floor_.width(); ++x) {
    for (const int row : {kFirst, kThird}) {
      EXPECT_TRUE(isAgainst(x, row, kWest)) << x;
      EXPECT_FALSE(isAgainst(x, row, kEast)) << x;
    }
    EXPECT_TRUE(isAgainst(x, kSecond, kEast)) << x;
    EXPECT_FALSE(isAgainst(x, kSecond, kWest)) << x;
  }
}

TEST_F(Streets, AreNarrow) {
  for (const int heading : {kEast, kWest}) EXPECT_FALSE(isAgainst(5, 1, heading));  // the open hall
  for (int y = 0; y < floor_.height(); ++y) {
    for (const int heading : {kNorth, kSouth}) EXPECT_FALSE(isAgainst(0, y, heading)) << y;
  }
}

TEST_F(Streets, CostMoreAgainstTheirDirectionFromTheFirstTick) {
  GuidanceOptions options;
  options.streets = 1;
  Guidance guidance(floor_, options);
  const int edge = (kFirst * floor_.width() + 5) * kHeadings;
  for (int tick = 0; tick < 2; ++tick) {
    EXPECT_EQ(guidance.costs()[edge + kWest], 2 * kTickCost);
    EXPECT_EQ(guidance.costs()[edge + kEast], kTickCost);
    guidance.tick();
    guidance.refresh();
  }
}

}  // namespace
}  // namespace fleet::test
