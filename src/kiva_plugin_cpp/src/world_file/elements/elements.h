// SPDX-License-Identifier: Apache-2.0
//
// Elements that models, links, joints and sensors have in common: plugins and parameters.
#pragma once

#include <string>
#include <vector>

#include "world_file/files/xml.h"

namespace kiva {

/// The `<plugin>` elements of a model or a world.
std::vector<PluginDescription> readPlugins(const XmlElement& element, const std::string& where);

/// Returns the text of every element in `element`, by path, with the defaults of missing elements
/// that SDF requires. `where` names a document that has no file.
Parameters readParameters(const XmlElement& element, const std::string& where);

/// Adds the defaults of `child`, if `element` has none.
void addMissing(const XmlElement& element, const std::string& child, Parameters* parameters);

}  // namespace kiva
