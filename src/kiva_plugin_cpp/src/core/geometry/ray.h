// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "kiva_plugin_cpp/description.h"

class btCollisionObject;

namespace kiva {

/// Returns the distance [m] along the unit vector `direction` at which a ray meets that body, +inf
/// = not within `range`.
double castBody(const btCollisionObject& body, const Vector3& from, const Vector3& direction,
                double range);

}  // namespace kiva
