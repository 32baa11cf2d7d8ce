// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "core/state/views/contact_view.h"

namespace kiva {

/// Reports each collision once, when its impact is over, and notes its robots as
/// ContactLog::crashes.
void observeCollisions(ContactView& world);
/// Forgets the contacts of a model that is removed, -1 = all, and reports pending ones.
void forgetContacts(const Scene& world, ContactLog& contact_log, EventLog& log, int slot);

}  // namespace kiva
