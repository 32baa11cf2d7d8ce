// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

#include "world_file/files/document.h"

namespace kiva {

/// Parses a text; leaves out faulty parts, each with a warning. Throws SdfError where nothing would
/// be left. Thread-safe.
SdfDocument parseSdf(const std::string& text, const ModelPaths& model_paths);

}  // namespace kiva
