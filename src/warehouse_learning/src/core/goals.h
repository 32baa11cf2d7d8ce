// SPDX-License-Identifier: Apache-2.0
//
// Goals that robots had better go for: hints to learn by, without force.
//
// A robot without a load: the nearest requested unit that is no other robot's goal. One with a
// requested unit: the nearest station. One with another unit: the nearest free storage place that
// is no other robot's goal.
#pragma once

#include <vector>

#include "floor.h"
#include "state.h"
#include "ways.h"

namespace learning {

/// Of all robots; kept until they are reached or no more to be had.
class Goals {
 public:
  Goals(const Floor& floor, const State& state);

  void begin(int w);           ///< Begins an episode: finds all goals again.
  void end(int w, int robot);  ///< It has lifted, delivered or put down.
  void changed(int w);         ///< Units stand elsewhere.
  /// Finds goals for those whose own is gone, which it can be only where there are news.
  void renew();

  /// The robot's goal; its own cell if it has none.
  int cell(int w, int robot) const { return cell_[w][robot]; }
  const Table<std::int32_t>& cells() const { return cell_; }
  /// nullptr if it has none.
  const Way* way(int w, int robot) const { return way_[w][robot]; }
  /// [cells] to go; 0 where there is no goal or no way.
  int distance(int w, int robot) const;

 private:
  struct Choice {
    int aim;  // as in aim_
    int cell;
    const Way* way;
  };

  bool isGone(int w, int robot) const;
  Choice choice(int aim, int cell, Deck deck) { return {aim, cell, &ways_.to(cell, deck)}; }
  void find(int w, int robot);
  /// Finds what is no robot's goal yet.
  void findOpen(int w);
  /// Returns the one that is nearest to the robot, the first of several; nullptr of none.
  const Choice* nearest(int w, int robot, const std::vector<Choice>& choices) const;
  /// The nearest becomes its goal, and no other robot's.
  void take(int w, int robot, std::vector<Choice>* open);

  const Floor& floor_;
  const State& state_;
  Ways ways_;
  std::vector<int> places_;  // of storage
  Table<std::int32_t> cell_;
  Table<const Way*> way_;
  Table<std::int32_t> aim_;  // unit, or cell of a storage place
  std::vector<Choice> stations_;
  // Of the warehouse that is renewed: requested units, free storage places.
  std::vector<Choice> open_units_, open_places_;
  std::vector<char> news_;  // by warehouse: there may be other goals than before
};

}  // namespace learning
