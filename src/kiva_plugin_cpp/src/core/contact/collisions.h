// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/state/views/contact_view.h"

namespace kiva {

/// Reports each collision once, when its impact is over, and notes the robots in it
/// as ContactLog::crashes.
void observeCollisions(ContactView& world);
/// Forgets the contacts of a model that is removed, -1 = all, and reports pending ones.
void forgetContacts(ContactView& world, int slot);

}  // namespace kiva
