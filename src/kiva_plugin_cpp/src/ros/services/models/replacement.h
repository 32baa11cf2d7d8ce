// SPDX-License-Identifier: Apache-2.0
//
// The parts of a request to replace models; see ReplaceModels.srv.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "kiva_plugin_cpp/world.h"
#include "kiva_plugin_cpp/world_file.h"
#include "ros/services/models/model_sources.h"

namespace kiva_ros {

/// One document of a request: its text, and its models.
struct ReplacementDocument {
  const std::string* text = nullptr;
  std::vector<kiva::ModelInstance> models;
  std::vector<WrittenModel> written;  ///< The models as the text has them.
};

/// Returns the content of a document; `field` names it in errors. Throws DescriptionError and
/// ServiceRefusal.
ReplacementDocument readDocument(const std::string& text, const std::string& field,
                                 const kiva::ModelPaths& paths, std::vector<std::string>* warnings);

/// Returns the models that stand and are to go: those that are named by a kind and a number, in the
/// order of the kinds, and then those of `names`.
std::vector<std::string> leavingModels(const kiva::World& world,
                                       const std::vector<std::string>& kinds,
                                       const std::vector<std::string>& names);

/// Throws ServiceRefusal for a model that has the name of another one of the documents, or of one
/// that stays.
void checkNames(const kiva::World& world, const std::vector<std::string>& leaving,
                const std::vector<ReplacementDocument>& documents);

/// Returns the number of models in all documents.
std::size_t modelCount(const std::vector<ReplacementDocument>& documents);

}  // namespace kiva_ros
