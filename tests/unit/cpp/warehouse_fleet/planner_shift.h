// SPDX-License-Identifier: Apache-2.0
//
// A shift on a floor with storage units: robots take units to stations and back; the validator
// checks every plan before it is driven.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "warehouse_fleet/epibt.h"
#include "warehouse_fleet/validator.h"

namespace fleet::test {

/// Returns a floor from a drawing: '.' an aisle, 'S' a storage place, 'E' a station in an aisle,
/// '#' a wall, '>' '<' '^' 'v' a lane.
inline FloorDescription drawn(const std::vector<std::string>& rows) {
  FloorDescription floor;
  floor.height = static_cast<int>(rows.size());
  floor.width = static_cast<int>(rows[0].size());
  for (const std::string& row : rows) {
    for (const char c : row) {
      const std::size_t lane = std::string(">v<^").find(c);
      floor.passable.push_back(c != '#');
      floor.storage.push_back(c == 'S');
      floor.lane.push_back(lane != std::string::npos);
      floor.exits.push_back(lane != std::string::npos ? 1 << lane : 0xf);
    }
  }
  return floor;
}

inline std::vector<Cell> cellsOf(const std::vector<std::string>& rows, char which) {
  std::vector<Cell> cells;
  const int width = static_cast<int>(rows[0].size());
  for (std::size_t y = 0; y < rows.size(); ++y) {
    for (int x = 0; x < width; ++x) {
      if (rows[y][x] == which) cells.push_back(static_cast<Cell>(y) * width + x);
    }
  }
  return cells;
}

/// Blocks of 4 x 2 storage places, aisles so wide between them, stations along the upper wall.
inline std::vector<std::string> blocks(int across, int down, int aisle) {
  const int width = across * (4 + aisle) + aisle + 2, height = down * (2 + aisle) + aisle + 2;
  std::vector<std::string> rows(height, std::string(width, '.'));
  for (int y = 0; y < down; ++y) {
    for (int x = 0; x < across; ++x) {
      for (int dy = 0; dy < 2; ++dy) {
        rows[1 + aisle + y * (2 + aisle) + dy].replace(1 + aisle + x * (4 + aisle), 4, "SSSS");
      }
    }
  }
  for (int x = 2; x < width - 1; x += 5) rows[0][x] = 'E';
  return rows;
}

class Shift {
 public:
  Shift(const std::vector<std::string>& rows, int robots, std::uint64_t seed,
        const Rules& rules = {}, const EpibtOptions& options = {})
      : floor(drawn(rows)), rules_(rules), random_(seed), planner_(makeEpibt(options)) {
    places_ = cellsOf(rows, 'S');
    stations_ = cellsOf(rows, 'E');
    std::vector<Cell> free = cellsOf(rows, '.');
    std::shuffle(free.begin(), free.end(), random_);
    std::shuffle(places_.begin(), places_.end(), random_);
    fleet.cell.assign(free.begin(), free.begin() + robots);
    for (int robot = 0; robot < robots; ++robot) {
      fleet.heading.push_back(static_cast<Heading>(random_() % kHeadings));
    }
    fleet.goal.assign(robots, kNowhere);
    fleet.loaded.assign(robots, 0);
    fleet.home.assign(robots, kNowhere);
    fleet.stopped.assign(robots, 0);
    fleet.committed_ticks = kService;
    service_.assign(robots, 0);
    since_.assign(robots, 0);
    planner_->start(floor, rules, seed);
  }

  /// Drives for `ticks`; returns false at the first invalid plan.
  bool run(int ticks, const Budget& budget = {}) {
    for (int tick = 0; tick < ticks; ++tick) {
      if (!step(budget)) return false;
    }
    return true;
  }

  bool step(const Budget& budget = {}) {
    giveGoals();
    commit();
    planner_->plan(fleet, budget, plan);
    const auto violations = validate(floor, fleet, plan, rules_);
    for (const Violation& violation : violations) ADD_FAILURE() << describe(violation, floor);
    drive();
    return violations.empty();
  }

  const Floor floor;
  Fleet fleet;
  Plan plan;
  int arrivals = 0;
  int longest = 0;  ///< ticks that a robot took to a goal
  std::vector<int> since() const { return since_; }

 private:
  static constexpr int kService = 3;  ///< ticks of a lift, or at a station
  static constexpr int kPlaces = 3;   ///< robots that may be on their way to one station

  /// One cycle: to a unit, with it to a station, back with it.
  void giveGoals() {
    for (int robot = 0; robot < fleet.size(); ++robot) {
      if (fleet.goal[robot] != kNowhere || service_[robot] > 0) continue;
      if (fleet.home[robot] == kNowhere) {
        fleet.home[robot] = places_.back();
        places_.pop_back();
        fleet.goal[robot] = fleet.home[robot];
      } else if (!fleet.loaded[robot]) {
        // Lifted only with a place at a station: who has none waits beneath its unit.
        const int station = static_cast<int>(random_() % stations_.size());
        if (std::count(fleet.goal.begin(), fleet.goal.end(), stations_[station]) >= kPlaces) {
          continue;
        }
        fleet.loaded[robot] = 1;
        fleet.goal[robot] = stations_[station];
      } else if (fleet.cell[robot] != fleet.home[robot]) {
        fleet.goal[robot] = fleet.home[robot];
      } else {
        fleet.loaded[robot] = 0;
        places_.insert(places_.begin(), fleet.home[robot]);
        fleet.home[robot] = kNowhere;
      }
    }
  }

  void commit() {
    fleet.committed.assign(fleet.size() * kService, Fleet::kFree);
    for (int robot = 0; robot < fleet.size(); ++robot) {
      for (int tick = 0; tick < service_[robot]; ++tick) {
        fleet.committed[robot * kService + tick] = static_cast<std::uint8_t>(Action::kWait);
      }
    }
  }

  void drive() {
    for (int robot = 0; robot < fleet.size(); ++robot) {
      const GridPose state =
          after(floor, {fleet.cell[robot], fleet.heading[robot]}, plan.at(robot, 0));
      fleet.cell[robot] = state.cell;
      fleet.heading[robot] = state.heading;
      if (service_[robot] > 0) --service_[robot];
      if (fleet.stopped[robot] || fleet.goal[robot] == kNowhere) continue;
      longest = std::max(longest, ++since_[robot]);
      if (fleet.cell[robot] != fleet.goal[robot]) continue;
      fleet.goal[robot] = kNowhere;
      service_[robot] = kService;
      since_[robot] = 0;
      ++arrivals;
    }
  }

  const Rules rules_;
  std::mt19937_64 random_;
  std::unique_ptr<Planner> planner_;
  std::vector<Cell> places_, stations_;
  std::vector<int> service_, since_;
};

}  // namespace fleet::test
