// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/state/contact_view.h"

namespace kiva {

/// Tells each contact that should not be once, when its impact is over, and notes the robots in it
/// as WorldState::crashes.
void observeCollisions(ContactView& world);
/// Forgets a model that is going, -1 = all; what has not been told yet is.
void forgetContacts(ContactView& world, int slot);

}  // namespace kiva
