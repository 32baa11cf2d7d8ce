// SPDX-License-Identifier: Apache-2.0
//
// What models, links, joints and sensors have in common: plugins and parameters.
#pragma once

#include <string>
#include <vector>

#include "world_file/files/xml.h"

namespace kiva {

/// The `<plugin>` elements of a model or a world.
std::vector<PluginDescription> readPlugins(const XmlElement& element, const std::string& where);

/// The text of every element in `element`, by path, with the defaults of those that SDF asks for
/// and are not there. `where` is put for the file of a document that was given as text.
Parameters readParameters(const XmlElement& element, const std::string& where);

/// Adds the defaults of `child`, if `element` has none.
void addMissing(const XmlElement& element, const std::string& child, Parameters* parameters);

}  // namespace kiva
