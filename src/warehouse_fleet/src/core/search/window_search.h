// SPDX-License-Identifier: Apache-2.0
//
// For few robots and much time: a large-neighbourhood search over windows of many ticks. Some
// robots that are in each other's way lose their paths and get others, one after the other by A*
// among the paths that stay; kept if all paths together cost no more (Jiang et al., Scaling
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
  /// All references must outlive it. Windows have so many ticks.
  WindowSearch(const Floor& floor, const Rules& rules, int ticks, const std::vector<Wish>& wishes,
               const Priorities& priorities, const Candidates& candidates);

  /// Tells whether it can plan for these robots: none carries a load, is stopped or committed.
  bool canPlan() const;
  /// Begins a step with what is left of the paths of the last; returns false, without any paths, if
  /// a robot is not where its path has it, or the path can't be driven any more.
  bool inherit();
  /// Begins a step with paths of so many ticks, at the end of which all stand.
  void adopt(const Reservations& reserved, int horizon);

  /// Looks for better paths, in attempts that `goes_on` allows.
  void improve(const std::function<bool()>& goes_on, std::mt19937_64& random);

  /// Replaces paths by the first `horizon` ticks of these.
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
  std::vector<WindowPath> kept_;         ///< their paths before
  std::vector<std::uint8_t> is_chosen_;  ///< by robot: is in the group
};

}  // namespace fleet
