// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "parts.h"

namespace kiva {

/// Reports each contact that should not be once, when its impact is over, and stops the robots in
/// it.
void reportCollisions(Parts& parts);
/// Forgets a model that is going, -1 = all; what has not been told yet is.
void forgetContacts(Parts& parts, int slot);

}  // namespace kiva
