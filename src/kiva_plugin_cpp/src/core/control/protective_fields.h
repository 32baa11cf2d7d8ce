// SPDX-License-Identifier: Apache-2.0
//
// How robots keep away from people: what each scanner's protective field allows, and light
// curtains. Where nobody is it costs a comparison a step.
#pragma once

#include "core/state/world_state.h"

namespace kiva {

/// Before robots are controlled: those whose scan has come slow down, stand, or go on.
void keepFromPeople(WorldState& world);
/// Whether anybody is there to keep from, or was a moment ago.
bool minds(const WorldState& world);

/// As World::setLightCurtain and World::removeLightCurtain say.
void setLightCurtain(WorldState& world, const LightCurtain& curtain);
bool removeLightCurtain(WorldState& world, const std::string& name);

}  // namespace kiva
