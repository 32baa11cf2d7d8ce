// SPDX-License-Identifier: Apache-2.0
#include "world_file/elements.h"

#include "world_file/errors.h"
#include "world_file/from_sdformat.h"

namespace kiva {
namespace {

/// Text of `element` and of all below it; a name that comes again is `name[2]`, `name[3]`, …, so
/// that no value is lost.
void addParameters(const sdf::ElementPtr& element, const std::string& path,
                   Parameters* parameters) {
  for (auto child = element->GetFirstElement(); child; child = child->GetNextElement()) {
    const std::string base = path + child->GetName();
    std::string key = base;
    for (int count = 2; parameters->has(key); ++count) {
      key = base + "[" + std::to_string(count) + "]";
    }
    if (child->GetFirstElement()) {
      addParameters(child, key + "/", parameters);
    } else {
      parameters->set(key, child->GetValue() ? child->GetValue()->GetAsString() : "");
    }
  }
}

}  // namespace

std::vector<PluginDescription> readPlugins(const sdf::ElementPtr& element,
                                           const std::string& where) {
  std::vector<PluginDescription> plugins;
  auto child = element->FindElement("plugin");
  for (; child; child = child->GetNextElement("plugin")) {
    PluginDescription plugin;
    plugin.name = child->Get<std::string>("name");
    plugin.filename = child->Get<std::string>("filename");
    plugin.parameters = readParameters(child, where);
    plugins.push_back(std::move(plugin));
  }
  return plugins;
}

Parameters readParameters(const sdf::ElementPtr& element, const std::string& where) {
  Parameters parameters(address(noteAt(element, ""), where));
  addParameters(element, "", &parameters);
  return parameters;
}

Pose resolved(const sdf::SemanticPose& pose, const sdf::ElementConstPtr& element,
              const std::string& to) {
  ignition::math::Pose3d result;
  const sdf::Errors errors = pose.Resolve(result, to);
  if (!errors.empty()) failAt(element, errors.front().Message());
  return fromSdformat(result);
}

}  // namespace kiva
