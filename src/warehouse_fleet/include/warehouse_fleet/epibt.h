// SPDX-License-Identifier: Apache-2.0
//
// The planner of the house: priority inheritance with backtracking over operations of several
// ticks (Yukhnevich and Andreychuk, AAAI 2026), led by costs that are learnt from the traffic, and
// improved by a large-neighbourhood search while time is left.
#pragma once

#include <cstddef>
#include <memory>

#include "warehouse_fleet/planner.h"

namespace fleet {

struct EpibtOptions {
  /// Ticks of an operation, 1 to 5; 0: 4, or 5 where the first step has time for it.
  int depth = 0;
  int horizon = 0;  ///< ticks of a plan, up to 7: what is committed, and an operation; 0: depth
  int turn_ticks =
      1;  ///< what a quarter turn costs on the way to a goal: with braking, more than a tick
  int revisits = 10;   ///< how often one robot may be moved aside for another
  int pushes = 400;    ///< how many robots may be moved aside to find one robot's operation
  int exchanges = 40;  ///< the same in the search for something better
  int patience = 30;   ///< ticks in a cell after which others make way for a robot
  /// How many robots may pursue their goals at a time, over the passable cells. Where there are
  /// more, the others yield: they go where they are pushed until it is their turn.
  double pursuing = 0.5;
  /// Ticks of the windows in which few robots with much time are planned, 7 to 31; 0: 15, if there
  /// are three cells a robot and the first step has time for it; -1: none are.
  int window = 0;
  /// A goal is where it stops (for a lift, say); else to have passed it is enough.
  bool goals_are_stops = true;
  std::size_t table_bytes = std::size_t{640} << 20;  ///< of distance tables kept
  int whole_up_to = 8192;  ///< cells of a floor each of whose tables has all cells
  int threads = 1;         ///< that share a step, with the same plan for any number; 0: all cores
  int table_work = 1500;   ///< states a robot that distance tables made in one step may have
  int renewal_work = 200;  ///< states a robot that tables renewed in one step may have
  int renewal_age = 20;    ///< ticks after which a table is renewed, if there is work left
  double against = 10;     ///< what it costs to meet one robot a tick head on [ticks]
  double crowd = 5;        ///< what it costs where one robot a tick waits [ticks]
  double resting = 0;      ///< what it costs where one stands that has come to its goal [ticks]
  double at_lanes = 0;     ///< what it costs beside stations' lanes [ticks]
  double memory = 50;      ///< for how long that is remembered [ticks]
};

std::unique_ptr<Planner> makeEpibt(const EpibtOptions& options = {});

}  // namespace fleet
