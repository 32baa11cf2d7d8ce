// SPDX-License-Identifier: Apache-2.0
#include "ros/services/models/replacement.h"

#include <algorithm>
#include <cctype>
#include <unordered_map>
#include <unordered_set>

#include "ros/services/base/service_answer.h"

namespace kiva_ros {
namespace {

constexpr std::size_t kMostBytes = 10'000'000;  // of a document; parsing takes many times its size

bool isNumbered(const std::string& name, const std::string& kind) {
  if (name.size() <= kind.size() || name.compare(0, kind.size(), kind) != 0) return false;
  const auto is_digit = [](unsigned char letter) { return std::isdigit(letter) != 0; };
  return std::all_of(name.begin() + static_cast<std::ptrdiff_t>(kind.size()), name.end(), is_digit);
}

std::string fieldOf(std::size_t document) { return "documents[" + std::to_string(document) + "]"; }

}  // namespace

ReplacementDocument readDocument(const std::string& text, const std::string& field,
                                 const kiva::ModelPaths& paths,
                                 std::vector<std::string>* warnings) {
  if (text.size() > kMostBytes) {
    throw ServiceRefusal(field + " has " + std::to_string(text.size()) + " bytes; at most " +
                         std::to_string(kMostBytes) + " are read");
  }
  std::vector<kiva::Light> lights;
  ReplacementDocument out;
  out.text = &text;
  out.models = kiva::parseModels(text, paths, field, warnings, &lights);
  if (!lights.empty()) {
    throw ServiceRefusal(field + " has the light '" + lights.front().name +
                         "'; models alone are replaced: spawn it by /gazebo/spawn_sdf_model");
  }
  for (const kiva::ModelInstance& model : out.models)
    out.written.push_back({model.name, model.pose});
  return out;
}

std::vector<std::string> leavingModels(const kiva::World& world,
                                       const std::vector<std::string>& kinds,
                                       const std::vector<std::string>& names) {
  const std::vector<std::string> standing = world.modelNames();
  std::vector<std::string> out;
  for (const std::string& kind : kinds) {
    for (const std::string& name : standing) {
      if (isNumbered(name, kind)) out.push_back(name);
    }
  }
  for (const std::string& name : names) {
    if (world.has(name)) out.push_back(name);
  }
  return out;
}

void checkNames(const kiva::World& world, const std::vector<std::string>& leaving,
                const std::vector<ReplacementDocument>& documents) {
  const std::unordered_set<std::string> gone(leaving.begin(), leaving.end());
  std::unordered_map<std::string, std::size_t> document_of;
  for (std::size_t i = 0; i < documents.size(); ++i) {
    for (const kiva::ModelInstance& model : documents[i].models) {
      const std::string where = fieldOf(i) + ": model '" + model.name + "': ";
      const auto [first, is_new] = document_of.emplace(model.name, i);
      if (!is_new) throw ServiceRefusal(where + fieldOf(first->second) + " has one of that name");
      if (world.has(model.name) && !gone.count(model.name)) {
        throw ServiceRefusal(where + "one of that name stands and is not among those that go");
      }
    }
  }
}

std::size_t modelCount(const std::vector<ReplacementDocument>& documents) {
  std::size_t count = 0;
  for (const ReplacementDocument& document : documents) count += document.models.size();
  return count;
}

}  // namespace kiva_ros
