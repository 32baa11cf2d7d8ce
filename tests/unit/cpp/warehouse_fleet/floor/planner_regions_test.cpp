// SPDX-License-Identifier: Apache-2.0
//
// Tables whose far part is shared by all goals of a region: they lead to the goal from everywhere,
// with hardly a detour, and are the same for any number of threads and after a file.
#include <array>
#include <sstream>
#include <vector>

#include "core/floor/distance_tables.h"
#include "planner_shift.h"

namespace fleet::test {
namespace {

constexpr std::size_t kBytes = std::size_t{64} << 20;
constexpr std::int64_t kWork = 1 << 30;

/// Tables of one floor, of all cells or by regions.
struct Tables {
  Tables(const Floor& floor, Cell whole_up_to, int threads = 1)
      : floor(floor),
        costs(floor.size() * kHeadings, kTickCost),
        edges{{floor.edges(Deck::kUnder), floor.edges(Deck::kAisles)}, &costs, {}},
        on(threads),
        tables(floor, edges, {1, kBytes, whole_up_to}, on) {}

  const DistanceTable* to(Cell goal, Deck deck = Deck::kAisles) {
    tables.begin(++now, 0, kWork);
    tables.need(deck, goal);
    tables.make();
    return tables.find(deck, goal, goal, false);
  }

  const Floor& floor;
  std::vector<std::uint8_t> costs;
  const Edges edges;
  const Threads on;
  DistanceTables tables;
  int now = 0;
};

/// Ticks of the way on which each action leads to where a table has it nearest; -1 if that ends
/// elsewhere than at the goal.
int follow(const Floor& floor, const DistanceTable& table, GridPose at, Cell goal) {
  for (int ticks = 0; ticks < 4 * floor.size(); ++ticks) {
    if (at.cell == goal) return ticks;
    GridPose best = at;
    for (const int turn : {1, 3}) {
      const GridPose there{at.cell, turned(at.heading, turn)};
      if (table.at(there.cell, there.heading) < table.at(best.cell, best.heading)) best = there;
    }
    const Cell ahead = floor.next(Deck::kAisles, at.cell, at.heading);
    const bool drives =
        ahead != kNowhere && table.at(ahead, at.heading) < table.at(best.cell, best.heading);
    if (drives) best = {ahead, at.heading};
    if (best == at) return -1;
    at = best;
  }
  return -1;
}

class Regional : public testing::Test {
 protected:
  const std::vector<std::string> rows_ = blocks(14, 20, 1);  // 73 x 63 cells
  const Floor floor_{drawn(rows_)};
  const std::vector<Cell> stations_ = cellsOf(rows_, 'E'), aisles_ = cellsOf(rows_, '.');
};

TEST_F(Regional, LeadToTheGoalFromEverywhere) {
  Tables regional(floor_, 0), exact(floor_, floor_.size());
  std::int64_t ticks = 0, least = 0;
  for (const Cell goal : {stations_.front(), stations_.back(), aisles_[1234], aisles_.back()}) {
    const DistanceTable& table = *regional.to(goal);
    const DistanceTable& all = *exact.to(goal);
    for (const Cell from : aisles_) {
      const int way = follow(floor_, table, {from, 0}, goal);
      ASSERT_GE(way, 0) << floor_.name(from) << " to " << floor_.name(goal);
      ticks += way;
      least += all.at(from, 0) / kTickCost;
    }
  }
  EXPECT_LT(ticks, 1.04 * least);  // a turn more
}

TEST_F(Regional, AreExactAroundTheGoal) {
  Tables regional(floor_, 0), exact(floor_, floor_.size());
  const Cell goal = aisles_[1500];
  const DistanceTable& table = *regional.to(goal);
  const DistanceTable& all = *exact.to(goal);
  for (const Cell from : aisles_) {
    const int columns = floor_.x(from) - floor_.x(goal), rows = floor_.y(from) - floor_.y(goal);
    if (columns * columns + rows * rows > 64) continue;
    for (int heading = 0; heading < kHeadings; ++heading) {
      EXPECT_EQ(table.at(from, heading), all.at(from, heading)) << floor_.name(from);
    }
  }
}

TEST_F(Regional, ShareMostOfTheirBytes) {
  Tables regional(floor_, 0), exact(floor_, floor_.size());
  const auto bytes = [&](Tables& tables) {
    for (int i = 0; i < 200; ++i) tables.to(aisles_[i]);
    return tables.tables.bytes();
  };
  EXPECT_LT(2 * bytes(regional), bytes(exact));
}

TEST_F(Regional, AreTheSameAfterAFile) {
  Tables first(floor_, 0), second(floor_, 0);
  first.tables.prepare([] { return true; });
  std::stringstream file;
  first.tables.save(file);
  second.tables.load(file);
  EXPECT_EQ(first.tables.count(), second.tables.count());
  const Cell goal = stations_.back();
  const DistanceTable &table = *first.to(goal), &other = *second.to(goal);
  for (const Cell from : aisles_) EXPECT_EQ(table.at(from, 0), other.at(from, 0));
}

std::string whyRefused(const Floor& floor, std::istream& file) {
  try {
    Tables(floor, 0).tables.load(file);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST_F(Regional, OfAnotherFloorAreRefused) {
  Tables tables(floor_, 0);
  tables.tables.prepare([] { return true; });
  std::stringstream file;
  tables.tables.save(file);
  const Floor other(drawn(blocks(14, 20, 2)));
  EXPECT_NE(whyRefused(other, file).find("x 63 cells, floor "), std::string::npos);
  const std::string half = file.str().substr(0, file.str().size() / 2);
  std::istringstream shorter(half);
  EXPECT_EQ(whyRefused(floor_, shorter), "the file ends before its last table");
}

/// A ring of blocks around a hole, with lanes of 14 cells and back beyond its last row: deeper than
/// a region, so that around some goals there is no cell but in lanes.
std::vector<std::string> ringWithLanes() {
  constexpr int kDeep = 14;
  std::vector<std::string> rows = blocks(14, 20, 1);
  for (int y = 15; y < 48; ++y) rows[y].replace(20, 33, 33, '#');
  std::string there(rows[0].size(), '#'), turn = there;
  for (std::size_t x = 3; x + 3 < there.size(); x += 8) {
    there.replace(x, 3, "v#^");
    turn.replace(x, 3, ">>^");
  }
  rows.insert(rows.end(), kDeep, there);
  rows.push_back(turn);
  return rows;
}

TEST(Lanes, OnALargeFloorShareTheTablesOfRegions) {
  const std::vector<std::string> rows = ringWithLanes();
  const Floor floor(drawn(rows));
  const std::vector<Cell> aisles = cellsOf(rows, '.'), turns = cellsOf(rows, '>');
  Tables regional(floor, 0), exact(floor, floor.size());
  std::int64_t ticks = 0, least = 0;
  for (std::size_t i = 1; i < turns.size(); i += 2) {
    const DistanceTable& table = *regional.to(turns[i]);
    const DistanceTable& all = *exact.to(turns[i]);
    for (const Cell from : aisles) {
      const int way = follow(floor, table, {from, 0}, turns[i]);
      ASSERT_GE(way, 0) << floor.name(from) << " to " << floor.name(turns[i]);
      ticks += way;
      least += all.at(from, 0) / kTickCost;
    }
  }
  EXPECT_LT(ticks, 1.04 * least);
  EXPECT_GT(regional.tables.count(), exact.tables.count());  // those of regions besides
}

TEST(Lanes, HaveTablesOfAllCellsOnASmallerFloor) {
  const std::vector<std::string> rows = ringWithLanes();
  const Floor floor(drawn(rows));
  Tables some(floor, floor.size() / 2), exact(floor, floor.size());
  const Cell goal = cellsOf(rows, '>')[1];
  const DistanceTable &table = *some.to(goal), &other = *exact.to(goal);
  for (const Cell from : cellsOf(rows, '.')) EXPECT_EQ(table.at(from, 0), other.at(from, 0));
  // Cells on which a robot can't stand take no room.
  EXPECT_LT(some.tables.bytes(), 0.8 * exact.tables.bytes());
}

TEST(Threads, AnyNumberGivesTheSamePlans) {
  std::vector<std::vector<Cell>> cells;
  for (const int threads : {1, 2, 4}) {
    EpibtOptions options;
    options.threads = threads;
    options.whole_up_to = 0;
    // So many robots that each thread has some.
    Shift shift(blocks(20, 20, 1), 1100, 3, {}, options);
    ASSERT_TRUE(shift.run(25, {0, 200}));
    EXPECT_GT(shift.arrivals, 0);
    cells.push_back(shift.fleet.cell);
  }
  EXPECT_EQ(cells[0], cells[1]);
  EXPECT_EQ(cells[0], cells[2]);
}

TEST(Threads, ThrowWhatATurnThrows) {
  const Threads threads(3);
  const auto turn = [](int i, int) {
    if (i == 57) throw std::runtime_error("57");
  };
  EXPECT_THROW(threads.share(100, 1, turn), std::runtime_error);
  std::vector<int> done(1000);
  threads.share(1000, 10, [&](int i, int) { ++done[i]; });
  EXPECT_EQ(done, std::vector<int>(1000, 1));
}

}  // namespace
}  // namespace fleet::test
