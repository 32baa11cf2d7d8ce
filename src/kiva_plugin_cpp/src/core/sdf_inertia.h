// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ignition/math/Inertial.hh>
#include <sdf/Element.hh>

#include "kiva_plugin_cpp/description.h"

namespace kiva {

/// Throws SdfError if the mass in an `<inertial>` is not positive or no body can have its inertia.
void checkInertial(const sdf::ElementPtr& inertial);

/// Into mass, principal moments and axes of `link`.
void setInertia(const ignition::math::Inertiald& inertial, Link* link);

}  // namespace kiva
