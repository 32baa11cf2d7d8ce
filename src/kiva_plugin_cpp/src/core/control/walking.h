// SPDX-License-Identifier: Apache-2.0
//
// People who walk: from waypoint to waypoint, and not into anything.
#pragma once

#include "core/state/world_state.h"

namespace kiva {

/// As World::walk and World::people say.
void walk(WorldState& world, const std::string& person, const Walk& walk);
std::vector<Person> peopleIn(const WorldState& world);

/// A model that has just come is an actor, who walks so.
void beginScript(WorldState& world, int model, const Walk& script);
/// Actors begin anew, everybody else is no person any more.
void restartScripts(WorldState& world);
/// A step of time goes by.
void walkOn(WorldState& world);

}  // namespace kiva
