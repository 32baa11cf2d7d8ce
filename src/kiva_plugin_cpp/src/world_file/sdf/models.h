// SPDX-License-Identifier: Apache-2.0
//
// Models of SDF to descriptions.
#pragma once

#include "kiva_plugin_cpp/description.h"
#include "world_file/sdf/links.h"

namespace kiva {

/// With nested models flattened. Throws SdfError.
ModelDescription describeModel(const XmlElement& model, const Origin& origin, Faults* warnings);

}  // namespace kiva
