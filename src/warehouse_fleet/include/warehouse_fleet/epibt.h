// SPDX-License-Identifier: Apache-2.0
//
// The built-in planner: priority inheritance with backtracking over operations of several ticks
// (Yukhnevich and Andreychuk, AAAI 2026). Costs that are learnt from the traffic guide it. A
// large-neighbourhood search improves each plan while time is left.
#pragma once

#include <cstddef>
#include <memory>

#include "warehouse_fleet/planner.h"

namespace fleet {

struct EpibtOptions {
  /// Ticks of an operation, 1 to 5; 0: 4, or 5 if the first step has time for it.
  int depth = 0;
  int horizon = 0;  ///< ticks of a plan, up to 7: what is committed, and an operation; 0: depth
  int turn_ticks =
      1;  ///< what a quarter turn costs on the way to a goal: with braking, more than a tick
  int revisits = 10;   ///< how often one robot may be moved aside for another
  int pushes = 400;    ///< how many robots may be moved aside to find one robot's operation
  int exchanges = 40;  ///< as `pushes`, in the search for a better plan
  int patience = 30;   ///< ticks in a cell after which others make way for a robot
  /// How many robots may pursue their goals at a time, as a share of the passable cells. Others
  /// yield: they go where they are pushed until it is their turn.
  double pursuing = 0.5;
  /// Ticks of a window in which a sparse fleet is planned if there is time, 7 to 31. 0: 15, if
  /// there are three cells a robot and the first step has time for it. -1: no windows.
  int window = 0;
  /// Whether a robot stops at its goal, as for a lift; otherwise it may just pass.
  bool goals_are_stops = true;
  std::size_t table_bytes = std::size_t{640} << 20;  ///< of distance tables kept
  int whole_up_to = 8192;  ///< on floors of up to so many cells each table covers all cells
  int threads = 1;         ///< threads of a step, same plan for any number; 0: all cores
  int table_work = 1500;   ///< states a robot for which a step may make distance tables
  int renewal_work = 200;  ///< states a robot for which a step may renew distance tables
  int renewal_age = 20;    ///< ticks after which a table is renewed, if there is work left
  double against = 10;     ///< cost of meeting one robot a tick head on [ticks]
  double crowd = 5;        ///< cost of a cell where one robot a tick waits [ticks]
  double resting = 0;      ///< cost of a cell where a robot stands at its goal [ticks]
  double at_lanes = 0;     ///< cost of a cell beside a station's lane [ticks]
  double memory = 50;      ///< how long traffic is remembered [ticks]
};

std::unique_ptr<Planner> makeEpibt(const EpibtOptions& options = {});

}  // namespace fleet
