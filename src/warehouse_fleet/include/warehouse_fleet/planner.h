// SPDX-License-Identifier: Apache-2.0
//
// The interface of planners. A planner gets the floor once, then plans the actions of all robots at
// each tick. A custom planner is one class,
//
//   #include "warehouse_layout/register_plugin.h"
//   class Mine : public fleet::Planner { … };
//   WAREHOUSE_ADD_PLUGIN(Mine, fleet::Planner)
// which loadPlanner loads from its library by name. examples/ has one to start from.
#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "warehouse_fleet/fleet.h"

namespace fleet {

/// The computing time of a step.
struct Budget {
  /// Time of the calling thread for the whole step [s]; 0: the first plan is not improved.
  double seconds = 0;
  /// Attempts to improve the plan; -1: unlimited within `seconds`. With a limit here and `seconds`
  /// 0, the same steps give the same plans on any machine.
  int attempts = -1;
};

class Planner {
 public:
  virtual ~Planner() = default;

  /// Called once, before the first step. `floor` outlives the planner.
  virtual void start(const Floor& floor, const Rules& rules, std::uint64_t seed) = 0;

  /// Called at each tick: plans the actions of at least one tick, from the present poses in
  /// `fleet`. Committed actions must be kept. Robots may be appended from tick to tick; if their
  /// number shrinks, indices may mean other robots.
  virtual void plan(const Fleet& fleet, const Budget& budget, Plan& plan) = 0;

  /// Prepares before the first step the data that every plan on the floor needs, within `seconds`
  /// of wall time. By default there is nothing to prepare.
  virtual void prepare(double seconds);
  /// Writes the prepared data to a file, or reads it for the same floor. Throws std::runtime_error
  /// with the reason.
  virtual void save(const std::string& path) const;
  virtual void load(const std::string& path);
};

/// Returns the planner `class_name` of the library at `path`. Throws std::runtime_error that names
/// the missing library or class.
std::shared_ptr<Planner> loadPlanner(const std::string& path, const std::string& class_name);

}  // namespace fleet
