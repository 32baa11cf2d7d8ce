// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "kiva_plugin_cpp/world.h"

namespace kiva_ros {

/// A model as a text has it.
struct WrittenModel {
  std::string name;
  kiva::Pose pose;
};

/// The text that a model comes from.
struct ModelSource {
  std::shared_ptr<const std::string> text;
  WrittenModel written;
};

/// Remembers which SDF text each model comes from. Belongs to the step thread once that runs.
class ModelSources {
 public:
  /// Begins with the models of a world file; a file that can't be read leaves them without a text.
  ModelSources(const std::string& world_file, const kiva::WorldDescription& description);

  /// Remembers the text of models that were spawned, and how it has each of them.
  void note(const kiva::World& world, const std::string& text,
            const std::vector<kiva::ModelInstance>& models,
            const std::vector<WrittenModel>& written);

  /// Returns the source of a model, or null if it is not known.
  const ModelSource* find(const std::string& model) const;

  /// The world's own file and its text.
  const std::string& worldFile() const { return world_file_; }
  const std::shared_ptr<const std::string>& worldText() const { return world_text_; }

 private:
  /// Returns a text that models already come from, where it is the same.
  std::shared_ptr<const std::string> shared(const std::string& text);
  void forgetRemoved(const kiva::World& world);

  const std::string world_file_;
  std::shared_ptr<const std::string> world_text_;
  std::map<std::string, ModelSource> sources_;
  std::map<std::size_t, std::weak_ptr<const std::string>> texts_;  ///< By their hashes.
};

}  // namespace kiva_ros
