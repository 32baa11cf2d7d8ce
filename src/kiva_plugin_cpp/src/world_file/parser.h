// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <sdf/Root.hh>
#include <sdf/Types.hh>
#include <set>
#include <string>

#include "kiva_plugin_cpp/world_file.h"

namespace kiva {

/// A text after libsdformat: free of errors that libsdformat can see.
struct SdfDocument {
  std::unique_ptr<sdf::Root> root;
  sdf::Errors warnings;
  /// Those of the models that the text includes, and where it looked for those that are missing.
  std::set<std::string> files;
};

/// Faulty parts are left out, with a warning each. Throws SdfError where nothing would be left, or
/// more than fifty million bytes would be read that way. Thread-safe, though one call waits for
/// another.
SdfDocument parseSdf(const std::string& text, const ModelPaths& model_paths);

}  // namespace kiva
