// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "world_file/files/document.h"

namespace kiva {

/// Replaces includes by the models that they name, and adds the files of these. IncludeGraph has
/// removed includes of missing models.
void expandIncludes(const ModelPaths& model_paths, SdfDocument* document);

}  // namespace kiva
