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

/// A model of its own file.
struct LibraryModel {
  std::string name;
  Pose pose;       ///< As its file has it, in world.
  Pose placement;  ///< Of the model, in its placement frame: what an include's pose is about.
  std::shared_ptr<const ModelDescription> description;  ///< Null: the file holds no model,
  std::optional<Light> light;                           ///< but a light, say.
  std::vector<std::string> warnings;
  FileStamps stamps;
};

/// The model at `folder`, read once and shared for as long as its files stay as they are.
/// Throws DescriptionError.
std::shared_ptr<const LibraryModel> libraryModel(const std::string& folder,
                                                 const ModelPaths& model_paths);

/// Adds the files of a model's meshes to `files`.
void addMeshFiles(const ModelDescription& description, std::set<std::string>* files);

}  // namespace kiva
