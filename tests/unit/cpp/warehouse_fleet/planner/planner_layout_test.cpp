// SPDX-License-Identifier: Apache-2.0
//
// Floors on which loaded robots can always go on, and floors that are refused with their cells.
#include "planner_shift.h"
#include "warehouse_layout/layout_check.h"

namespace fleet::test {
using layout::LayoutFault;
namespace {

std::string faults(const std::vector<std::string>& rows) {
  const Floor floor(drawn(rows));
  std::string text;
  for (const LayoutFault& fault : checkLayout(floor)) text += describe(fault, floor) + "\n";
  return text;
}

TEST(Layout, BlocksWithAislesAroundThemAreRight) {
  for (const int aisle : {1, 2, 3}) EXPECT_EQ(faults(blocks(4, 3, aisle)), "");
}

TEST(Layout, ALaneMayBeOneWay) {
  EXPECT_EQ(faults({"#>>>>#",  //
                    "......",  //
                    "......"}),
            "no loaded robot can drive there and back to the other aisles: "
            "(1, 0), (2, 0), (3, 0), (4, 0)\n");
  EXPECT_EQ(faults({"^>>>v#",  //
                    "^...v#",  //
                    "......",  //
                    "......"}),
            "no loaded robot can drive there and back to the other aisles: (0, 0), (0, 1)\n");
  EXPECT_EQ(faults({">>>>v#",  //
                    "^...v#",  //
                    "......",  //
                    "......"}),
            "");
}

TEST(Layout, ADeadEndIsRefused) {
  EXPECT_EQ(faults({"....#",  //
                    "....#",  //
                    "#.###",  //
                    "#.###"}),
            "two robots that meet could not pass each other (no cycle of three cells or more): "
            "(1, 1) to (1, 2), (1, 2) to (1, 3), (1, 2) to (1, 1), (1, 3) to (1, 2)\n");
}

TEST(Layout, APartThatIsCutOffIsRefused) {
  EXPECT_EQ(faults({"...#..",  //
                    "...#.."}),
            "no loaded robot can drive there and back to the other aisles: "
            "(4, 0), (5, 0), (4, 1), (5, 1)\n");
}

TEST(Layout, AStoragePlaceWithoutAnAisleIsRefused) {
  EXPECT_EQ(faults({".....",  //
                    ".SSS.",  //
                    ".SSS.",  //
                    ".SSS.",  //
                    "....."}),
            "no loaded robot can drive there and back to the other aisles: (2, 2)\n");
}

TEST(Layout, AFloorWithoutAislesIsRefused) {
  EXPECT_EQ(faults({"SS", "SS"}), "there is no aisle for a loaded robot to drive on\n");
}

TEST(Floor, RefusesWhatIsNone) {
  FloorDescription description;
  EXPECT_THROW(Floor{description}, FloorError);
  description.width = description.height = 2;
  description.passable = {1, 1, 1};
  try {
    Floor floor(description);
    FAIL() << "3 cells of 4";
  } catch (const FloorError& error) {
    EXPECT_STREQ(error.what(), "passable has 3 elements; width * height = 4 were expected");
  }
}

}  // namespace
}  // namespace fleet::test
