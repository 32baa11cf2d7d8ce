// SPDX-License-Identifier: Apache-2.0
//
// A user's planner, from its library.
#include <memory>

#include "planner_shift.h"

namespace fleet::test {
namespace {

const std::string kLibrary = RIGHT_OF_WAY;

std::string refusal(const std::string& path, const std::string& name) {
  try {
    loadPlanner(path, name);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(LoadPlanner, RunsTheExample) {
  const Floor floor(drawn({"......", "......"}));
  const auto planner = loadPlanner(kLibrary, "RightOfWay");
  planner->start(floor, {}, 1);
  Fleet fleet;
  fleet.cell = {0, 6};
  fleet.heading = {0, 3};
  fleet.goal = {5, 11};
  Plan plan;
  for (int tick = 0; tick < 6; ++tick) {
    planner->plan(fleet, {}, plan);
    ASSERT_TRUE(validate(floor, fleet, plan, {}).empty());
    for (int robot = 0; robot < 2; ++robot) {
      const State state =
          after(floor, {fleet.cell[robot], fleet.heading[robot]}, plan.at(robot, 0));
      fleet.cell[robot] = state.cell;
      fleet.heading[robot] = state.heading;
    }
  }
  EXPECT_EQ(fleet.cell, fleet.goal);
}

TEST(LoadPlanner, SaysWhatIsMissing) {
  EXPECT_EQ(refusal(kLibrary, "Other"),
            kLibrary + ": no class Other; it has RightOfWay (fleet::Planner)");
  EXPECT_EQ(refusal("/nowhere.so", "Mine"),
            "/nowhere.so: cannot open shared object file: No such file or directory");
  EXPECT_EQ(refusal(LAYOUT_LIBRARY, "Mine"),
            LAYOUT_LIBRARY ": no library with a registered planner");
}

TEST(LoadPlanner, FindsAClassWhateverItsNamespace) {
  EXPECT_NE(loadPlanner(kLibrary, "mine::RightOfWay"), nullptr);
}

TEST(LoadPlanner, NamesTheInterfaceOfAClassThatIsNoPlanner) {
  const std::string library = HELLO_PLUGIN;
  if (library.empty()) GTEST_SKIP() << "built without the world's package";
  EXPECT_EQ(refusal(library, "Patrol"),
            library +
                ": Patrol is registered as kiva::Plugin; WAREHOUSE_ADD_PLUGIN(Patrol, "
                "fleet::Planner) was expected");
}

}  // namespace
}  // namespace fleet::test
