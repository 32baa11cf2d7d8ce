// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>

#include "kiva_plugin_cpp/world_file.h"

namespace kiva {

/// Returns the folder or file that the uri of an include names; empty if nothing is found. The uri
/// is an absolute path, with or without `file://`; or `model://name`, `model://name/file` or a
/// relative path, which is searched for in the paths.
std::string findModel(const std::string& uri, const ModelPaths& paths);

/// Returns the file that the uri of a mesh names; empty if no file is found. The uri is an absolute
/// path; `model://` or `package://`, searched for in the paths; or a relative path, with or without
/// `file://`, searched for in `folder`, in its parents, in the paths and in the parents of these.
/// The ending may differ in case.
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

/// Adds the files that would make `uri` a model: a missing one may appear later.
void addCandidates(const std::string& uri, const ModelPaths& paths, std::set<std::string>* files);

}  // namespace kiva
