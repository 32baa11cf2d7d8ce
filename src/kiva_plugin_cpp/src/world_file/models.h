// SPDX-License-Identifier: Apache-2.0
//
// libsdformat's models → our descriptions.
#pragma once

#include <sdf/Model.hh>
#include <sdf/Types.hh>

#include "kiva_plugin_cpp/description.h"
#include "world_file/links.h"

namespace kiva {

/// With nested models flattened. Throws SdfError.
ModelDescription describeModel(const sdf::Model& model, const Origin& origin,
                               sdf::Errors* warnings);

}  // namespace kiva
