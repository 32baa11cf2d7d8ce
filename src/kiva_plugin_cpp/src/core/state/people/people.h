// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <vector>

#include "core/state/people/walker.h"
#include "kiva_plugin_cpp/people.h"
#include "kiva_plugin_cpp/world.h"

namespace kiva {

/// The people of a world, and the devices that keep robots away from them.
struct People {
  std::vector<Walker> walkers;  ///< In order of arrival.
  std::vector<LightCurtain> curtains;
  bool field_was_occupied =
      false;  ///< There were people at the last step of the protective fields.

  /// Returns whether robots have a person to slow down for, or had one a step ago.
  bool slowsRobots() const { return !walkers.empty() || field_was_occupied; }
  /// Returns the person of the model in that slot, or null.
  Walker* find(int model);
  const Walker* find(int model) const;
  /// Returns the largest walking speed of a model [m/s]; 0 if it is no person.
  double walkingSpeed(int model) const {
    if (walkers.empty()) return 0;
    const Walker* walker = find(model);
    return walker && walker->walks() ? kMostWalkingSpeed : 0;
  }
  Twist twist(int model) const;
  /// Removes the person of the model in that slot, if there is one.
  void forget(int model);
};

}  // namespace kiva
