// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ignition/math/Inertial.hh>
#include <sdf/Element.hh>
#include <sdf/Types.hh>

#include "kiva_plugin_cpp/description.h"

namespace kiva {

/// Takes out of a link what is wrong with its `<inertial>`, with a warning: a mass that is not
/// positive, an inertia that no body can have. SDF's defaults of 1 kg and 1 kg m² are left.
void repairInertial(const sdf::ElementPtr& link, sdf::Errors* warnings);

/// Reads an inertial into mass, principal moments and axes of `link`.
void setInertia(const ignition::math::Inertiald& inertial, Link* link);

}  // namespace kiva
