// SPDX-License-Identifier: Apache-2.0
//
// How robots keep away from people: what each scanner's protective field allows, and light
// curtains. Where nobody is it costs a comparison a step.
#pragma once

#include "core/state/motion_view.h"

namespace kiva {

/// Before robots are controlled: those whose scan has come slow down, stand, or go on.
void keepFromPeople(MotionView& world, People& people, const std::vector<int>& scans_due);
/// Whether anybody is there to keep from, or was a moment ago.
bool minds(const People& people);

/// As World::setLightCurtain and World::removeLightCurtain say.
void setLightCurtain(People& people, const LightCurtain& curtain);
bool removeLightCurtain(People& people, const std::string& name);

}  // namespace kiva
