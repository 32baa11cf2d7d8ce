// SPDX-License-Identifier: Apache-2.0
//
// Reads sensors of SDF links, and lights.
#pragma once

#include "world_file/sdf/links.h"

namespace kiva {

/// Reads the `<sensor>` elements of a link; leaves out faulty ones, with a warning.
void addSensors(const XmlElement& link, const Scope& scope, ModelDescription* description,
                Faults* warnings);

/// Returns a light at that pose in world.
Light describeLight(const XmlElement& light, const Pose& pose);

}  // namespace kiva
