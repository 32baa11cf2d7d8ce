// SPDX-License-Identifier: Apache-2.0
//
// libsdformat's models → our descriptions.
#pragma once

#include <sdf/Element.hh>
#include <sdf/Model.hh>
#include <sdf/SemanticPose.hh>
#include <sdf/Types.hh>
#include <string>
#include <vector>

#include "kiva_plugin_cpp/description.h"
#include "world_file/links.h"

namespace kiva {

/// With nested models flattened. Throws SdfError.
ModelDescription describeModel(const sdf::Model& model, const Origin& origin,
                               sdf::Errors* warnings);

/// The `<plugin>` elements of a model or a world.
std::vector<PluginDescription> readPlugins(const sdf::ElementPtr& element,
                                           const std::string& where);

/// The text of every element in `element`, by path. `where` as above.
Parameters readParameters(const sdf::ElementPtr& element, const std::string& where);

/// `pose` in the frame of what holds `element`, or in the frame `to`. Throws SdfError.
Pose resolved(const sdf::SemanticPose& pose, const sdf::ElementConstPtr& element,
              const std::string& to = "");

}  // namespace kiva
