// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "kiva_plugin_cpp/world_file.h"

namespace kiva {

/// Throws SdfError if a model that `xml` includes includes itself in the end: libsdformat would
/// follow it until the stack is full.
void checkCycles(const std::string& xml, const ModelPaths& model_paths);

}  // namespace kiva
