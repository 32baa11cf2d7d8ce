// SPDX-License-Identifier: Apache-2.0
//
// What an SDF link and an SDF world have beyond shapes: sensors, lights.
#pragma once

#include <sdf/Light.hh>
#include <sdf/Link.hh>
#include <vector>

#include "kiva_plugin_cpp/description.h"
#include "world_file/links.h"

namespace kiva {

/// The sensors of a link.
void addSensors(const sdf::Link& link, const Scope& scope, ModelDescription* description,
                sdf::Errors* warnings);

/// A light at that pose in world.
Light describeLight(const sdf::Light& light, const Pose& pose);

}  // namespace kiva
