// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>

#include "kiva_plugin_cpp/world_file.h"

namespace kiva {

/// The folder, or the file, that the uri of an include names: an absolute path, with `file://` or
/// without; else `model://name`, `model://name/file` or a relative path, looked up in the paths.
/// Empty if there is none.
std::string findModel(const std::string& uri, const ModelPaths& paths);

/// The file that the uri of a mesh names: an absolute path; `model://` and `package://`, looked up
/// in the paths; or a relative path, with `file://` or without, looked up in `folder`, in those
/// above it, in the paths and in the folders that hold them. Its ending may differ in case. Empty
/// if there is none.
std::string findFile(const std::string& uri, const std::string& folder, const ModelPaths& paths);

/// Returns the message for a file that is in none of the folders.
std::string fileNotFound(const std::string& uri, const std::string& folder,
                         const ModelPaths& paths);
/// Returns the parts of a list of folders, `a:b`.
ModelPaths splitPaths(const std::string& list);

/// Returns the message for a model that is in none of the folders.
std::string modelNotFound(const std::string& uri, const ModelPaths& paths);
/// Returns the warning that an include is left out since its model is missing.
std::string leftOut(const std::string& uri, const ModelPaths& paths);

/// Returns the SDF file of the model in `folder`, by its model.config. Throws SdfError.
std::string modelFile(const std::string& folder);

/// Adds the files that would make `uri` a model: a missing one may be added later.
void addCandidates(const std::string& uri, const ModelPaths& paths, std::set<std::string>* files);

}  // namespace kiva
