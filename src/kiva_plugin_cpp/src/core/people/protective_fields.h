// SPDX-License-Identifier: Apache-2.0
//
// Keeps robots away from people: the speed that each scanner's protective field allows, and light
// curtains. Without people it costs a comparison a step.
#pragma once

#include "core/state/views/motion_view.h"

namespace kiva {

/// Slows, stops and releases the robots whose scans are due, before robots are controlled.
void applyProtectiveFields(MotionView& world, People& people, const std::vector<int>& scans_due);

/// Implement World::setLightCurtain and World::removeLightCurtain.
void setLightCurtain(People& people, const LightCurtain& curtain);
bool removeLightCurtain(People& people, const std::string& name);

}  // namespace kiva
