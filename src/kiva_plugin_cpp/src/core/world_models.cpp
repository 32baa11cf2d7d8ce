// SPDX-License-Identifier: Apache-2.0
#include <stdexcept>

#include "core/communication/reports.h"
#include "core/control/shadows.h"
#include "core/models/models.h"
#include "core/models/ordinary_models.h"
#include "core/people/walking.h"
#include "core/state/places/poses.h"
#include "core/state/world_state.h"
#include "kiva_plugin_cpp/principal_inertia.h"
#include "kiva_plugin_cpp/world.h"

namespace kiva {
namespace {

constexpr double kLeastMass = 1e-6, kMostMass = 1e9;  // [kg]
constexpr double kLeastMoment = 1e-12;                // [kg m²]
constexpr double kMostArm = 1000;                     // [m]

}  // namespace

void World::spawn(const ModelInstance& instance) {
  spawnModel(state_->view, instance);
  if (!instance.walk) return;
  beginScript(state_->view, state_->people, state_->models.slot_of_name.at(instance.name),
              *instance.walk);
}

void World::spawn(const std::vector<ModelInstance>& instances) {
  std::size_t done = 0;
  try {
    for (; done < instances.size(); ++done) spawn(instances[done]);
  } catch (const DescriptionError&) {
    while (done > 0) remove(instances[--done].name);
    throw;
  }
}

bool World::remove(const std::string& model) {
  const auto at = state_->models.slot_of_name.find(model);
  if (at == state_->models.slot_of_name.end()) return false;
  const Model& leaving = *state_->models[at->second];
  const int robot = leaving.owner->robot(state_->view, leaving);
  if (robot >= 0) endShadow(state_->shadows, state_->fleet.robots[robot].id);
  removeModel(state_->view, at->second);
  return true;
}

bool World::has(const std::string& model) const { return state_->models.find(model) != nullptr; }

std::vector<std::string> World::modelNames() const {
  std::vector<std::string> names;
  for (int slot : state_->models.inOrder()) names.push_back(state_->models[slot]->name);
  return names;
}

ModelKind World::kind(const std::string& name) const {
  const Model* model = state_->models.find(name);
  return model ? model->kind : ModelKind::kOther;
}

std::uint64_t World::modelsRevision() const { return state_->models.revision; }

std::optional<EntityState> World::state(const std::string& name, const std::string& link) const {
  const Model* model = state_->models.find(name);
  if (!model) return std::nullopt;
  if (link.empty()) return modelState(state_->view, *model);
  const int index = linkIndex(model, link);
  if (index < 0) return std::nullopt;
  return linkState(state_->view, *model, index);
}

std::shared_ptr<const ModelDescription> World::description(const std::string& name) const {
  const Model* model = state_->models.find(name);
  return model ? model->description : nullptr;
}

bool World::setState(const std::string& name, const EntityState& state) {
  Model* model = state_->models.find(name);
  if (!model) return false;
  placeModel(state_->view, *model, state);
  const int robot = model->owner->robot(state_->view, *model);
  if (robot >= 0) recordPlacement(state_->view, state_->failures, robot);
  return true;
}

void World::states(std::vector<EntityState>* out) const {
  out->clear();
  for (int slot : state_->models.inOrder()) {
    out->push_back(modelState(state_->view, *state_->models[slot]));
  }
}

bool World::setVelocity(const std::string& name, const Twist& twist) {
  Model* model = state_->models.find(name);
  if (!model || model->kind != ModelKind::kOther) return false;
  if (!model->owner->followsBodies(*model)) return false;
  if (!twist.linear.IsFinite() || !twist.angular.IsFinite()) {
    throw DescriptionError("the velocity of '" + name + "' must be finite");
  }
  setModelTwist(*model, twist);
  return true;
}

bool World::setLinkState(const std::string& name, const std::string& link,
                         const EntityState& state) {
  Model* model = state_->models.find(name);
  const int index = linkIndex(model, link);
  if (index < 0) return false;
  placeLink(state_->view, *model, index, state);
  return true;
}

void World::linkStates(std::vector<std::string>* names, std::vector<EntityState>* states) const {
  names->clear();
  states->clear();
  for (int slot : state_->models.inOrder()) {
    const Model& model = *state_->models[slot];
    const auto& links = model.description->links;
    for (std::size_t i = 0; i < links.size(); ++i) {
      names->push_back(model.name + "::" + links[i].name);
      states->push_back(linkState(state_->view, model, static_cast<int>(i)));
    }
  }
}

bool World::setLinkInertia(const std::string& name, const Link& link) {
  Model* model = state_->models.find(name);
  const int index = linkIndex(model, link.name);
  if (index < 0) return false;
  const InertiaTensor inertia{link.principal_moments, Vector3::Zero};
  const bool is_usable =
      link.mass >= kLeastMass && link.mass <= kMostMass && link.principal_moments.IsFinite() &&
      link.principal_moments.Min() >= kLeastMoment && link.inertial_pose_in_link.IsFinite() &&
      link.inertial_pose_in_link.Pos().Abs().Max() <= kMostArm;
  if (!is_usable || !inertia.isPossible(link.mass)) {
    throw std::invalid_argument(
        "no body is like that; expected a mass above 0 kg, principal moments above 0 kg m², none "
        "larger than the sum of the other two, and a centre of mass near the link");
  }
  reweighLink(state_->view, *model, index, link);
  return true;
}

}  // namespace kiva
