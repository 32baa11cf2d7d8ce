// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <set>
#include <string>

#include "kiva_plugin_cpp/world_file.h"

namespace kiva {

/// Whether `uri` is looked up in the model paths: `model://name` or `model://name/file`.
bool isModelUri(const std::string& uri);

/// The folder, or the file, that `uri` names; empty if there is none.
std::string findModel(const std::string& uri, const ModelPaths& paths);

/// The file that the uri of a mesh names: `model://`, `package://`, `file://`, an absolute path, or
/// one relative to `folder`; empty if there is none.
std::string findFile(const std::string& uri, const std::string& folder, const ModelPaths& paths);

/// What to tell a person who asked for a model that is in none of the folders.
std::string modelNotFound(const std::string& uri, const ModelPaths& paths);
/// The same, and that the include goes without it.
std::string leftOut(const std::string& uri, const ModelPaths& paths);

/// Adds the files that would make `uri` a model: what was missing may come.
void addCandidates(const std::string& uri, const ModelPaths& paths, std::set<std::string>* files);

}  // namespace kiva
