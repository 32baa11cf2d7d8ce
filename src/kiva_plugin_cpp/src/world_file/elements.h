// SPDX-License-Identifier: Apache-2.0
//
// What models, links, joints and sensors have in common: plugins, parameters, poses.
#pragma once

#include <sdf/Element.hh>
#include <sdf/SemanticPose.hh>
#include <string>
#include <vector>

#include "kiva_plugin_cpp/description.h"

namespace kiva {

/// The `<plugin>` elements of a model or a world.
std::vector<PluginDescription> readPlugins(const sdf::ElementPtr& element,
                                           const std::string& where);

/// The text of every element in `element`, by path. `where` is put for the file of a
/// document that was given as text.
Parameters readParameters(const sdf::ElementPtr& element, const std::string& where);

/// `pose` in the frame of what holds `element`, or in the frame `to`. Throws SdfError.
Pose resolved(const sdf::SemanticPose& pose, const sdf::ElementConstPtr& element,
              const std::string& to = "");

}  // namespace kiva
