// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "world_file/files/xml.h"

namespace kiva {

/// Removes faults from a link's `<inertial>`, with a warning: a mass that is not positive, an
/// inertia that no body can have. SDF's defaults of 1 kg and 1 kg m² take their place.
void repairInertial(XmlElement* link, Faults* warnings);

/// Reads an `<inertial>` into mass, principal moments and axes of `link`. Null gives the defaults.
void setInertia(const XmlElement* inertial, Link* link);

}  // namespace kiva
