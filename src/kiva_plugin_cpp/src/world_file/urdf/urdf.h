// SPDX-License-Identifier: Apache-2.0
//
// Halls in URDF: buildings that are fixed to the world, without masses.
#pragma once

#include <string>

#include "world_file/files/document.h"

namespace kiva {

/// Returns the model that a `<robot>` describes, as SDF. Adds to `parsed` the lines of its
/// elements, and a warning for each text that should be a number. Throws SdfError.
std::unique_ptr<XmlDocument> sdfFromUrdf(const XmlDocument& urdf, SdfDocument* parsed);

/// Returns a URDF in which every link has an inertial: Gazebo leaves out links without one, and
/// with them a hall's walls.
std::string withInertias(const std::string& urdf);

/// Makes a model static if none of its joints can move: as a world, it is a hall.
void letStand(ModelInstance* model);

}  // namespace kiva
