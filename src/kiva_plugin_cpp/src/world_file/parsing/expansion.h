// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "world_file/files/document.h"

namespace kiva {

/// Puts models in the place of the includes that name them, and adds the files that they came from.
/// IncludeGraph has left only what leads somewhere.
void expandIncludes(const ModelPaths& model_paths, SdfDocument* document);

}  // namespace kiva
