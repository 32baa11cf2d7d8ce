// SPDX-License-Identifier: Apache-2.0
//
// Shadows of robots that are elsewhere: they stand where those are, and do what those do.
#pragma once

#include "core/state/robots/shadows.h"
#include "core/state/views/model_view.h"

namespace kiva {

/// Implements World::shadow.
void moveShadow(ModelView& world, Shadows& shadows, int kiva_id, const ShadowReport& report);
/// Forgets that the robot of that id was a shadow.
void endShadow(Shadows& shadows, int kiva_id);

}  // namespace kiva
