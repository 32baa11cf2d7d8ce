// SPDX-License-Identifier: Apache-2.0
#include "ros/services/models/model_sources.h"

#include <fstream>
#include <functional>
#include <iterator>

namespace kiva_ros {
namespace {

// Removed models stay known, for an undo may bring them back, until they are this many more than
// those that stand there.
constexpr std::size_t kMostRemoved = 10'000;

std::string textOf(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

}  // namespace

ModelSources::ModelSources(const std::string& world_file, const kiva::WorldDescription& description)
    : world_file_(world_file),
      world_text_(std::make_shared<const std::string>(textOf(world_file))) {
  if (world_text_->empty()) return;
  for (const kiva::ModelInstance& model : description.models) {
    sources_[model.name] = {world_text_, {model.name, model.pose}};
  }
}

void ModelSources::note(const kiva::World& world, const std::string& text,
                        const std::vector<kiva::ModelInstance>& models,
                        const std::vector<WrittenModel>& written) {
  const auto kept = shared(text);
  for (std::size_t i = 0; i < models.size(); ++i) {
    sources_[models[i].name] = {kept, written[i]};
  }
  if (sources_.size() > world.modelNames().size() + kMostRemoved) forgetRemoved(world);
}

const ModelSource* ModelSources::find(const std::string& model) const {
  const auto at = sources_.find(model);
  return at == sources_.end() ? nullptr : &at->second;
}

std::shared_ptr<const std::string> ModelSources::shared(const std::string& text) {
  std::weak_ptr<const std::string>& entry = texts_[std::hash<std::string>()(text)];
  auto kept = entry.lock();
  if (kept && *kept == text) return kept;
  kept = std::make_shared<const std::string>(text);
  entry = kept;
  return kept;
}

void ModelSources::forgetRemoved(const kiva::World& world) {
  for (auto at = sources_.begin(); at != sources_.end();) {
    at = world.has(at->first) ? std::next(at) : sources_.erase(at);
  }
  for (auto at = texts_.begin(); at != texts_.end();) {
    at = at->second.expired() ? texts_.erase(at) : std::next(at);
  }
}

}  // namespace kiva_ros
