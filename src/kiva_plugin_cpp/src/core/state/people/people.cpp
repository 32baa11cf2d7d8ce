// SPDX-License-Identifier: Apache-2.0
#include "core/state/people/people.h"

#include <algorithm>

namespace kiva {

const Walker* People::find(int model) const {
  const auto is_it = [model](const Walker& walker) { return walker.model == model; };
  const auto at = std::find_if(walkers.begin(), walkers.end(), is_it);
  return at == walkers.end() ? nullptr : &*at;
}

Walker* People::find(int model) {
  return const_cast<Walker*>(static_cast<const People*>(this)->find(model));
}

Twist People::twist(int model) const {
  const Walker* walker = find(model);
  return walker ? Twist{{walker->vx, walker->vy, 0}, {}} : Twist();
}

void People::forget(int model) {
  const auto is_it = [model](const Walker& walker) { return walker.model == model; };
  walkers.erase(std::remove_if(walkers.begin(), walkers.end(), is_it), walkers.end());
}

}  // namespace kiva
