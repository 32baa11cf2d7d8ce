// SPDX-License-Identifier: Apache-2.0
#include "world_file/models.h"

#include <algorithm>

#include "world_file/elements.h"
#include "world_file/errors.h"
#include "world_file/links.h"
#include "world_file/sensors.h"
#include "world_file/stand_in.h"

namespace kiva {
namespace {

/// What is static in a model that moves does not: its links from `first` on are fixed.
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
void addModel(const sdf::Model& model, const Scope& scope, ModelDescription* description,
              sdf::Errors* warnings) {
  for (uint64_t i = 0; i < model.LinkCount(); ++i) {
    description->links.push_back(describeLink(*model.LinkByIndex(i), scope, warnings));
    addSensors(*model.LinkByIndex(i), scope, description, warnings);
  }
  for (uint64_t i = 0; i < model.JointCount(); ++i) {
    buildOrLeaveOut("joint", warnings, [&] {
      description->joints.push_back(describeJoint(*model.JointByIndex(i), scope));
    });
  }
  for (auto& plugin : readPlugins(model.Element(), scope.origin.where)) {
    description->plugins.push_back(std::move(plugin));
  }
  for (uint64_t i = 0; i < model.ModelCount(); ++i) {
    const sdf::Model& nested = *model.ModelByIndex(i);
    const std::string name = scope.prefix + nested.Name();
    description->nested_models.push_back(name);
    const Pose pose = scope.pose * resolved(nested.SemanticPose(), nested.Element(), "__model__");
    const std::size_t first = description->links.size();
    const bool is_static = scope.is_static || nested.Static();
    addModel(nested, {scope.origin, name + "::", pose, is_static}, description, warnings);
    if (nested.Static() && !description->is_static) holdToWorld(first, description);
  }
}

/// Returns whether a model is static: itself, or since it only wraps static ones.
bool isStatic(const sdf::Model& model) {
  if (model.Static()) return true;
  if (model.LinkCount() > 0 || model.ModelCount() == 0) return false;
  for (uint64_t i = 0; i < model.ModelCount(); ++i) {
    if (!isStatic(*model.ModelByIndex(i))) return false;
  }
  return true;
}

/// Puts the link that stands for the whole model first, the others as they came.
void putFirst(const std::string& canonical, std::vector<Link>* links) {
  const auto is_canonical = [&](const Link& link) { return link.name == canonical; };
  std::stable_partition(links->begin(), links->end(), is_canonical);
}

}  // namespace

ModelDescription describeModel(const sdf::Model& model, const Origin& origin,
                               sdf::Errors* warnings) {
  ModelDescription description;
  description.is_static = isStatic(model);
  addModel(model, {origin, "", Pose::Zero, description.is_static}, &description, warnings);
  addStandIn(model, &description, warnings);
  putFirst(model.CanonicalLinkAndRelativeName().second, &description.links);
  return description;
}

}  // namespace kiva
