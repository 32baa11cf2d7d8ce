// SPDX-License-Identifier: Apache-2.0
//
// Reads sensors of SDF links, and lights.
#pragma once

#include <sdf/Light.hh>
#include <sdf/Link.hh>
#include <vector>

#include "kiva_plugin_cpp/description.h"
#include "world_file/links.h"

namespace kiva {

/// Returns the sensors of a link.
void addSensors(const sdf::Link& link, const Scope& scope, ModelDescription* description,
                sdf::Errors* warnings);

/// Returns a light at that pose in world.
Light describeLight(const sdf::Light& light, const Pose& pose);

}  // namespace kiva
