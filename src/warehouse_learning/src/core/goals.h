// SPDX-License-Identifier: Apache-2.0
//
// Goals of robots: hints for learning, which robots need not follow.
// A robot without a load: the nearest requested unit that is no other robot's goal. With a
// requested unit: the nearest station. With another unit: the nearest free storage place that is no
// other robot's goal.
#pragma once

#include <vector>

#include "floor.h"
#include "state.h"
#include "ways.h"

namespace learning {

/// The goals of all robots, each kept until it is reached or no longer available.
class Goals {
 public:
  Goals(const RimmedFloor& floor, const TaskState& state);

  void begin(int w);  ///< Begins an episode: chooses all goals.
  void end(int w,
           int robot);  ///< Ends the goal of a robot that has lifted, delivered or put down a unit.
  void changed(int w);  ///< Notes that units stand elsewhere.
  /// Chooses goals for robots whose own is gone, in warehouses with changes.
  void renew();

  /// Returns the robot's goal; its own cell if it has none.
  int cell(int w, int robot) const { return cell_[w][robot]; }
  const Table<std::int32_t>& cells() const { return cell_; }
  /// Returns the way to the robot's goal; nullptr if it has none.
  const Way* way(int w, int robot) const { return way_[w][robot]; }
  /// Returns the distance to the goal [cells]; 0 if there is no goal or no way.
  int distance(int w, int robot) const;

 private:
  struct Choice {
    int aim;  // goal, as in aim_
    int cell;
    const Way* way;
  };

  bool isGone(int w, int robot) const;
  Choice choice(int aim, int cell, Deck deck) { return {aim, cell, &ways_.to(cell, deck)}; }
  void find(int w, int robot);
  /// Collects possible goals that are no robot's yet.
  void findOpen(int w);
  /// Returns the choice nearest to the robot, the first of several; nullptr if there is none.
  const Choice* nearest(int w, int robot, const std::vector<Choice>& choices) const;
  /// Takes the nearest choice as the robot's goal, which is then no other robot's.
  void take(int w, int robot, std::vector<Choice>* open);

  const RimmedFloor& floor_;
  const TaskState& state_;
  WayTable ways_;
  std::vector<int> places_;  // storage places
  Table<std::int32_t> cell_;
  Table<const Way*> way_;
  Table<std::int32_t> aim_;  // unit, or cell of a storage place
  std::vector<Choice> stations_;
  // Possible goals in the warehouse that is renewed: requested units, free storage places.
  std::vector<Choice> open_units_, open_places_;
  std::vector<char> news_;  // by warehouse: whether possible goals have changed
};

}  // namespace learning
