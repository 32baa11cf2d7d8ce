// SPDX-License-Identifier: Apache-2.0
#include "world_file/sdf/models.h"

#include <algorithm>

#include "world_file/elements/elements.h"
#include "world_file/elements/frames.h"
#include "world_file/elements/values.h"
#include "world_file/sdf/links.h"
#include "world_file/sdf/sensors.h"
#include "world_file/sdf/stand_in.h"

namespace kiva {
namespace {

/// Fixes to the world the links from `first` on: those of a static model nested in one that moves.
void holdToWorld(std::size_t first, ModelDescription* description) {
  for (std::size_t i = first; i < description->links.size(); ++i) {
    const Link& link = description->links[i];
    Joint joint;
    joint.name = link.name + "::static";
    joint.parent = "world";
    joint.child = link.name;
    joint.anchor_in_model = link.pose_in_model.Pos();
    description->joints.push_back(joint);
  }
}

/// Adds the parts of `model`, then those of the models inside it.
void addModel(const XmlElement& model, const Scope& scope, ModelDescription* description,
              Faults* warnings) {
  forEach(model, "link", [&](const XmlElement& link) {
    description->links.push_back(describeLink(link, scope, warnings));
    addSensors(link, scope, description, warnings);
  });
  forEach(model, "joint", [&](const XmlElement& joint) {
    buildOrLeaveOut("joint", warnings,
                    [&] { description->joints.push_back(describeJoint(joint, scope)); });
  });
  for (auto& plugin : readPlugins(model, scope.origin.where)) {
    description->plugins.push_back(std::move(plugin));
  }
  forEach(model, "model", [&](const XmlElement& nested) {
    const std::string name = scope.prefix + attributeOf(nested, "name");
    description->nested_models.push_back(name);
    const Pose pose = scope.pose * poseAround(nested);
    const std::size_t first = description->links.size();
    const bool is_fixed = flagIn(nested, "static", false);
    const bool self_collide = flagIn(nested, "self_collide", false);
    addModel(nested, {scope.origin, name + "::", pose, scope.is_static || is_fixed, self_collide},
             description, warnings);
    if (is_fixed && !description->is_static) holdToWorld(first, description);
  });
}

/// Returns whether a model is static, or only wraps static ones.
bool isStatic(const XmlElement& model) {
  if (flagIn(model, "static", false)) return true;
  if (model.FirstChildElement("link") || !model.FirstChildElement("model")) return false;
  bool are_static = true;
  forEach(model, "model", [&](const XmlElement& nested) { are_static &= isStatic(nested); });
  return are_static;
}

/// Moves the canonical link to the front, and keeps the order of the others.
void putFirst(const std::string& canonical, std::vector<Link>* links) {
  const auto is_canonical = [&](const Link& link) { return link.name == canonical; };
  std::stable_partition(links->begin(), links->end(), is_canonical);
}

}  // namespace

ModelDescription describeModel(const XmlElement& model, const Origin& origin, Faults* warnings) {
  ModelDescription description;
  description.is_static = isStatic(model);
  const bool self_collide = flagIn(model, "self_collide", false);
  addModel(model, {origin, "", Pose::Zero, description.is_static, self_collide}, &description,
           warnings);
  addStandIn(model, &description, warnings);
  putFirst(canonicalLinkOf(model), &description.links);
  return description;
}

}  // namespace kiva
