// SPDX-License-Identifier: Apache-2.0
//
// Shadows of robots that are elsewhere: they repeat the poses and states of these.
#pragma once

#include "core/state/robots/shadows.h"
#include "core/state/views/model_view.h"

namespace kiva {

/// Implements World::shadow.
void moveShadow(ModelView& world, Shadows& shadows, int kiva_id, const ShadowReport& report);
/// Ends the state of being a shadow for the robot of that id.
void endShadow(Shadows& shadows, int kiva_id);

}  // namespace kiva
