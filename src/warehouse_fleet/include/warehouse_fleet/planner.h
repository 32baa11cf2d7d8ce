// SPDX-License-Identifier: Apache-2.0
//
// The interface of planners. A planner is given the floor once, then asked at each tick what all
// robots do next. A planner of your own is one class,
//
//   #include "warehouse_layout/register_plugin.h"
//   class Mine : public fleet::Planner { … };
//   WAREHOUSE_ADD_PLUGIN(Mine, fleet::Planner)
//
// Give its library and its name to loadPlanner. examples/ has one to start from.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "warehouse_fleet/fleet.h"

namespace fleet {

/// How long a step may look for a better plan, once there is one.
struct Budget {
  /// Computing time of the calling thread for the whole step [s]; 0: only until the first plan.
  double seconds = 0;
  /// Attempts to improve the plan; -1: as many as `seconds` allow. With a number here and
  /// `seconds` 0 the same steps give the same plans on any machine.
  int attempts = -1;
};

class Planner {
 public:
  virtual ~Planner() = default;

  /// Called once, before the first step. `floor` outlives the planner.
  virtual void start(const Floor& floor, const Rules& rules, std::uint64_t seed) = 0;

  /// Called at each tick: plans actions for one tick or more ahead, from where the robots of
  /// `fleet` stand. Committed actions must be kept. From tick to tick robots may be added at the
  /// end; if their number shrinks, all may be others.
  virtual void plan(const Fleet& fleet, const Budget& budget, Plan& plan) = 0;

  /// Prepares before the first step what every plan on the floor needs, within `seconds` of wall
  /// time. By default there is nothing to prepare.
  virtual void prepare(double seconds);
  /// Writes what was prepared to a file, or reads it for the same floor. Throws std::runtime_error
  /// that says what is wrong.
  virtual void save(const std::string& path) const;
  virtual void load(const std::string& path);
};

/// Returns the planner `class_name` of the library at `path`. Throws std::runtime_error that says
/// what is missing.
std::shared_ptr<Planner> loadPlanner(const std::string& path, const std::string& class_name);

}  // namespace fleet
