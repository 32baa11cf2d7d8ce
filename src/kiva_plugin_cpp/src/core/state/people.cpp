// SPDX-License-Identifier: Apache-2.0
#include "core/state/people.h"

#include <algorithm>

namespace kiva {

const Walker* findWalker(const WorldState& world, int model) {
  const auto is_it = [model](const Walker& walker) { return walker.model == model; };
  const auto at = std::find_if(world.walkers.begin(), world.walkers.end(), is_it);
  return at == world.walkers.end() ? nullptr : &*at;
}

Walker* findWalker(WorldState& world, int model) {
  return const_cast<Walker*>(findWalker(static_cast<const WorldState&>(world), model));
}

Twist walkingTwist(const WorldState& world, int model) {
  const Walker* walker = findWalker(world, model);
  return walker ? Twist{{walker->vx, walker->vy, 0}, {}} : Twist();
}

void forgetWalker(WorldState& world, int model) {
  const auto is_it = [model](const Walker& walker) { return walker.model == model; };
  auto& walkers = world.walkers;
  walkers.erase(std::remove_if(walkers.begin(), walkers.end(), is_it), walkers.end());
}

}  // namespace kiva
