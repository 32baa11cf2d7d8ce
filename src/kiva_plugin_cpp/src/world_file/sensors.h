// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "world_file/links.h"

namespace kiva {

/// The `<sensor>` elements of a link; those that make no sense are left out, with a warning.
void addSensors(const XmlElement& link, const Scope& scope, ModelDescription* description,
                Faults* warnings);

/// `pose`: in world.
Light describeLight(const XmlElement& light, const Pose& pose);

}  // namespace kiva
