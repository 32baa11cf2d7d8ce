// SPDX-License-Identifier: Apache-2.0
//
// A large-neighbourhood search over windows of many ticks, for few robots and much time. Some
// robots in each other's way lose their paths and get others, one after the other by A* among the
// remaining paths. The result is kept if all paths together cost no more (Jiang et al., Scaling
// Lifelong Multi-Agent Path Finding to More Realistic Settings, 2024, have windows of that kind).
#pragma once

#include <functional>
#include <random>
#include <utility>
#include <vector>

#include "core/search/candidates.h"
#include "core/search/priorities.h"
#include "core/search/window_paths.h"
#include "core/search/window_route.h"

namespace fleet {

class WindowSearch {
 public:
  /// Keeps all references, which must outlive the object. `ticks`: length of a window.
  WindowSearch(const Floor& floor, const Rules& rules, int ticks, const std::vector<Wish>& wishes,
               const Priorities& priorities, const Candidates& candidates);

  /// Returns whether it can plan for these robots: none is loaded, stopped or committed.
  bool canPlan() const;
  /// Begins a step with the rest of the last step's paths. Returns false, without any paths, if a
  /// robot is elsewhere than planned, or a path can't be driven any more.
  bool inherit();
  /// Begins a step with the planner's paths, after which all robots stand.
  void adopt(const Reservations& reserved, int horizon);

  /// Searches for better paths while `goes_on` returns true.
  void improve(const std::function<bool()>& goes_on, std::mt19937_64& random);

  /// Writes the first `horizon` ticks of the window's paths.
  void write(Reservations& reserved, int horizon) const;

 private:
  bool canDrive(const Wish& wish, const WindowPath& path) const;
  void improveEach();
  void chooseGroup(int robot, std::mt19937_64& random);
  void addBlockers(int robot, int most);
  void addNear(int robot, int most, std::mt19937_64& random);
  void add(int robot);
  bool replaceGroup();
  int weight(int robot) const;
  std::int64_t weigh(int robot, int cost) const;
  int costOf(const Wish& wish, const WindowPath& path) const;
  int least(int robot) const;

  const Floor& floor_;
  const Rules rules_;
  const std::vector<Wish>& wishes_;
  const Priorities& priorities_;
  const Candidates& candidates_;
  WindowPaths paths_;
  WindowRoute route_;
  bool has_paths_ = false;
  std::vector<int> group_;               ///< robots of one attempt
  std::vector<WindowPath> kept_;         ///< their previous paths
  std::vector<std::uint8_t> is_chosen_;  ///< by robot: is in the group
};

}  // namespace fleet
