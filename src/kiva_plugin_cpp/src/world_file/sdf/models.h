// SPDX-License-Identifier: Apache-2.0
//
// Describes models of SDF.
#pragma once

#include "kiva_plugin_cpp/description.h"
#include "world_file/sdf/links.h"

namespace kiva {

/// Returns the description of a model, with nested models flattened. Throws SdfError.
ModelDescription describeModel(const XmlElement& model, const Origin& origin, Faults* warnings);

}  // namespace kiva
