// SPDX-License-Identifier: Apache-2.0
#include "core/state/models/model.h"

#include <algorithm>

namespace kiva {

bool ModelOwner::followsBodies(const Model& model) const {
  return model.in_physics && !model.isStatic() && !model.bodies.links.empty();
}

bool isAwake(const Model& model) {
  return std::any_of(model.bodies.links.begin(), model.bodies.links.end(),
                     [](const LinkBody& link) { return link.body->isActive(); });
}

int linkIndex(const ModelDescription& description, const std::string& name) {
  for (std::size_t i = 0; i < description.links.size(); ++i) {
    if (description.links[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

int numberIn(const std::string& name, const std::string& prefix) {
  if (name.rfind(prefix, 0) != 0) return 0;
  const std::string digits = name.substr(prefix.size());
  if (digits.empty() || digits.size() > 7 || digits[0] == '0' ||
      digits.find_first_not_of("0123456789") != std::string::npos) {
    return 0;
  }
  return std::stoi(digits);
}

}  // namespace kiva
