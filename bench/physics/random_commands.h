// SPDX-License-Identifier: Apache-2.0
//
// The workload of the warehouse: the next command of each idle robot. It goes a few cells, turns,
// or fetches a storage unit near it, carries it around and puts it down. Free of ROS, so that the
// same commands are given in-process and over topics.
#pragma once

#include <cmath>
#include <cstdint>
#include <map>
#include <random>
#include <utility>

#include "kiva_plugin_cpp/command.h"

namespace bench {

/// Where a robot that waits for its next command stands.
struct Waiting {
  int kiva_id = 0;
  double x = 0, y = 0;  ///< In world [m].
  int shelf_id = 0;     ///< The carried unit, 0 = none.
};

class RandomCommands {
 public:
  explicit RandomCommands(std::uint64_t seed) : random_(seed) {}

  /// Notes that a storage unit stands there, in world [m], also after a robot put it down.
  void standsAt(int shelf_id, double x, double y) { units_[cell(x, y)] = shelf_id; }
  /// Notes that a robot lifted the unit there.
  void liftedAt(double x, double y) { units_.erase(cell(x, y)); }

  kiva::Command next(const Waiting& robot) {
    kiva::Command command;
    command.kiva_id = robot.kiva_id;
    const double dice = std::uniform_real_distribution<>()(random_);
    const auto below = units_.find(cell(robot.x, robot.y));
    if (robot.shelf_id && dice < 0.25) {
      lift(&command, 0, robot.shelf_id);
    } else if (!robot.shelf_id && below != units_.end() && dice < 0.5) {
      lift(&command, 1, below->second);
    } else if (dice < 0.6) {
      command.kind = kiva::Command::Kind::kMoveTo;
      command.x = std::round(robot.x) + cells();
      command.y = std::round(robot.y) + cells();
    } else if (dice < 0.9) {
      const bool along_x = dice < 0.75;
      command.kind = along_x ? kiva::Command::Kind::kMoveX : kiva::Command::Kind::kMoveY;
      (along_x ? command.x : command.y) = cells();
    } else {
      command.kind = kiva::Command::Kind::kRotate;
      command.direction = dice < 0.95 ? 1 : -1;
    }
    return command;
  }

 private:
  using Cell = std::pair<int, int>;
  static constexpr int kFar = 6;  // cells

  static Cell cell(double x, double y) {
    return {static_cast<int>(std::lround(x)), static_cast<int>(std::lround(y))};
  }
  int cells() { return std::uniform_int_distribution<>(-kFar, kFar)(random_); }

  static void lift(kiva::Command* command, int carry, int shelf_id) {
    command->kind = kiva::Command::Kind::kLift;
    command->lift = carry;
    command->shelf_id = shelf_id;
  }

  std::mt19937_64 random_;
  std::map<Cell, int> units_;
};

}  // namespace bench
