// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ignition/math/Inertial.hh>
#include <sdf/Element.hh>

#include "kiva_plugin_cpp/description.h"

namespace kiva {

/// Throws SdfError at the first link below `element` whose mass is not positive or whose inertia no
/// body can have.
void checkInertias(const sdf::ElementPtr& element);

/// Into mass, principal moments and axes of `link`.
void setInertia(const ignition::math::Inertiald& inertial, Link* link);

}  // namespace kiva
