// SPDX-License-Identifier: Apache-2.0
//
// URDF as people have halls in it: a building that is fixed to the world, without masses.
#pragma once

#include <string>

#include "kiva_plugin_cpp/description.h"

namespace kiva {

/// A URDF whose links without an inertial have one: libsdformat leaves out those that have none,
/// and a hall's walls with them.
std::string withInertias(const std::string& urdf);

/// Makes a model static if none of its joints can move: as a world, it is a hall.
void letStand(ModelInstance* model);

}  // namespace kiva
