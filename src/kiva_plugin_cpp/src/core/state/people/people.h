// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/state/people/walker.h"
#include "kiva_plugin_cpp/people.h"
#include "kiva_plugin_cpp/world.h"

namespace kiva {

/// The people of a world, and what keeps robots away from them.
struct People {
  std::vector<Walker> walkers;  ///< In the order in which they came.
  std::vector<LightCurtain> curtains;
  bool field_was_occupied = false;  ///< There were people when protective fields were applied last.

  /// Returns whether robots have a person to slow down for, or had one a step ago.
  bool slowsRobots() const { return !walkers.empty() || field_was_occupied; }
  /// Returns the person that the model in that slot is; null: it is none.
  Walker* find(int model);
  const Walker* find(int model) const;
  /// Returns how fast a model may come nearer by walking [m/s]; 0: it does not.
  double walkingSpeed(int model) const {
    if (walkers.empty()) return 0;
    const Walker* walker = find(model);
    return walker && walker->walks() ? kMostWalkingSpeed : 0;
  }
  Twist twist(int model) const;
  /// Removes the person that the model in that slot is, if it is one.
  void forget(int model);
};

}  // namespace kiva
