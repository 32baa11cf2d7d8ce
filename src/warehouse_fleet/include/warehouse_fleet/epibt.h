// SPDX-License-Identifier: Apache-2.0
//
// The built-in planner: priority inheritance with backtracking over operations of several ticks
// (Yukhnevich and Andreychuk, AAAI 2026). Edge costs learnt from traffic guide it. A
// large-neighbourhood search improves each plan within the budget.
#pragma once

#include <cstddef>
#include <memory>

#include "warehouse_fleet/planner.h"

namespace fleet {

struct EpibtOptions {
  /// Ticks of an operation, 1 to 5; 0: 4, or 5 if the first step's budget allows it.
  int depth = 0;
  int horizon = 0;  ///< ticks of a plan, up to 7: committed actions, then an operation; 0: depth
  int turn_ticks =
      1;  ///< cost of a quarter turn on the way to a goal [ticks]: with braking, more than its time
  int revisits = 10;  ///< largest number of times that one robot is moved aside for another
  int pushes =
      400;  ///< largest number of robots moved aside in the search for one robot's operation
  int exchanges = 40;  ///< the same in the search for a better plan
  int patience = 30;   ///< ticks in a cell after which others make way for a robot
  /// Largest number of robots that pursue their goals at a time, as a share of the passable cells.
  /// Others yield: they go where they are pushed until it is their turn.
  double pursuing = 0.45;
  /// Ticks of the windows in which a sparse fleet is planned if the budget allows it, 7 to 31. 0:
  /// 15, if there are three cells a robot and the first step's budget allows it. -1: no windows.
  int window = 0;
  /// Whether a robot stops at its goal, as for a lift; otherwise it may just pass.
  bool goals_are_stops = true;
  std::size_t table_bytes = std::size_t{640} << 20;  ///< memory limit of distance tables [byte]
  int whole_up_to = 8192;  ///< largest floor [cells] on which each table covers all cells
  int threads = 1;         ///< threads of a step; the plan does not depend on it; 0: all cores
  int table_work = 1500;   ///< states per robot in distance tables that a step may make
  int renewal_work = 200;  ///< states per robot in distance tables that a step may renew
  int renewal_age = 20;    ///< age at which a table is renewed, within renewal_work [ticks]
  /// Cost of one oncoming robot a tick [ticks]; -1: 10, or 3 in windows, in which robots evade each
  /// other in time.
  double against = -1;
  double crowd = 5;     ///< cost of a cell where one robot a tick waits [ticks]
  double resting = 0;   ///< cost of a cell where a robot stands at its goal [ticks]
  double at_lanes = 0;  ///< cost of a cell beside a station's lane [ticks]
  double streets = 3;   ///< cost against the direction that a narrow street is given [ticks]
  double memory = 50;   ///< time constant of the traffic average [ticks]
};

std::unique_ptr<Planner> makeEpibt(const EpibtOptions& options = {});

}  // namespace fleet
