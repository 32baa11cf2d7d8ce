// SPDX-License-Identifier: Apache-2.0
//
// Who of the models is a person.
#pragma once

#include "core/state/world_state.h"

namespace kiva {

/// Null: it is none.
Walker* findWalker(WorldState& world, int model);
const Walker* findWalker(const WorldState& world, int model);
/// How fast a model may come nearer by walking [m/s]; 0: it does not.
inline double walkingSpeed(const WorldState& world, int model) {
  if (world.walkers.empty()) return 0;
  const Walker* walker = findWalker(world, model);
  return walker && walker->walks() ? kMostWalkingSpeed : 0;
}
Twist walkingTwist(const WorldState& world, int model);
/// It is no person any more.
void forgetWalker(WorldState& world, int model);

}  // namespace kiva
