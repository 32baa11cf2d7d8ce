// SPDX-License-Identifier: Apache-2.0
//
// What every planner is: told the floor once, then asked at each tick what all robots do next. A
// user's own is one class,
//
//   #include "warehouse_layout/register_plugin.h"
//   class Mine : public fleet::Planner { … };
//   WAREHOUSE_ADD_PLUGIN(Mine, fleet::Planner)
//
// whose library and name are given to loadPlanner. examples/ has one to start from.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "warehouse_fleet/fleet.h"

namespace fleet {

/// How long a step may look for a better plan, once there is one.
struct Budget {
  /// Computing time of the calling thread for the whole step [s]; 0: what the first plan needs.
  double seconds = 0;
  /// Attempts to improve the plan; -1: as many as `seconds` allow. With a number here and
  /// `seconds` 0 the same steps give the same plans, whatever the machine.
  int attempts = -1;
};

class Planner {
 public:
  virtual ~Planner() = default;

  /// Once, before the first step. `floor` outlives the planner.
  virtual void start(const Floor& floor, const Rules& rules, std::uint64_t seed) = 0;

  /// One tick: the robots of `fleet` as they stand, to actions for one tick or more ahead. What
  /// is committed must be kept. Called again a tick later with what has become of it; robots may
  /// have been added at the end, or all be others if their number shrinks.
  virtual void plan(const Fleet& fleet, const Budget& budget, Plan& plan) = 0;

  /// Makes ahead of the first step what every plan on the floor needs, for so long by the clock at
  /// most [s]. By default there is nothing to be made.
  virtual void prepare(double seconds);
  /// Writes what was prepared, or reads what was prepared for the same floor. Throws
  /// std::runtime_error that says what is wrong.
  virtual void save(const std::string& path) const;
  virtual void load(const std::string& path);
};

/// The planner `class_name` in the library at `path`. Throws std::runtime_error that says what is
/// missing.
std::shared_ptr<Planner> loadPlanner(const std::string& path, const std::string& class_name);

}  // namespace fleet
