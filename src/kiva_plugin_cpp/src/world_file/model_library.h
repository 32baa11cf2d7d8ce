// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "kiva_plugin_cpp/world_file.h"
#include "world_file/files/file_stamps.h"

namespace kiva {

/// A model read from a file of its own.
struct LibraryModel {
  std::string name;
  Pose pose;       ///< Pose in world, as the file has it.
  Pose placement;  ///< Pose of the model in its placement frame, to which an include's pose refers.
  std::shared_ptr<const ModelDescription> description;  ///< Null: the file holds no model,
  std::optional<Light> light;                           ///< but perhaps a light.
  std::vector<std::string> warnings;
  FileStamps stamps;
};

/// Returns the model at `folder`, read once and shared while its files do not change. Throws
/// DescriptionError.
std::shared_ptr<const LibraryModel> libraryModel(const std::string& folder,
                                                 const ModelPaths& model_paths);

/// Adds the files of a model's meshes to `files`.
void addMeshFiles(const ModelDescription& description, std::set<std::string>* files);

}  // namespace kiva
