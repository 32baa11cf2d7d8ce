// SPDX-License-Identifier: Apache-2.0
//
// URDF as people have halls in it: a building that is fixed to the world, without masses.
#pragma once

#include <string>

#include "world_file/files/document.h"

namespace kiva {

/// Returns the model that a `<robot>` describes, as SDF. `parsed` is told the lines that its
/// elements come from, and in warnings which numbers are none. Throws SdfError.
std::unique_ptr<XmlDocument> sdfFromUrdf(const XmlDocument& urdf, SdfDocument* parsed);

/// A URDF whose links without an inertial have one: Gazebo leaves out those that have none,
/// and a hall's walls with them.
std::string withInertias(const std::string& urdf);

/// Makes a model static if none of its joints can move: as a world, it is a hall.
void letStand(ModelInstance* model);

}  // namespace kiva
