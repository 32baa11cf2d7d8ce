// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <stdexcept>

#include "core/contact/external_wrenches.h"
#include "core/models/models.h"
#include "core/motion/joints/joints.h"
#include "core/state/world_state.h"
#include "kiva_plugin_cpp/world.h"

namespace kiva {

std::optional<JointState> World::joint(const std::string& name, const std::string& joint) const {
  const Model* model = state_->models.find(name);
  const int index = model ? findJoint(*model, joint) : -1;
  if (index < 0) return std::nullopt;
  return jointState(state_->view.fleet, *model, index);
}

std::optional<JointWrench> World::jointWrench(const std::string& name,
                                              const std::string& joint) const {
  const Model* model = state_->models.find(name);
  const int index = model ? findJoint(*model, joint) : -1;
  if (index < 0) return std::nullopt;
  return kiva::jointWrench(*model, index);
}

bool World::setJoint(const std::string& name, const std::string& joint,
                     const JointSettings& settings) {
  Model* model = state_->models.find(name);
  const int index = model ? findJoint(*model, joint) : -1;
  if (index < 0) return false;
  kiva::setJoint(*model, index, settings);
  return true;
}

void World::setJointPositions(const std::string& name,
                              const std::map<std::string, double>& positions) {
  Model* model = state_->models.find(name);
  if (!model) throw std::invalid_argument("there is no model '" + name + "'");
  placeJoints(state_->view, *model, positions);
}

const ExternalInputs& World::externalInputs() const { return state_->external_inputs; }

bool World::applyWrench(const std::string& name, const std::string& link, const Vector3& force,
                        const Vector3& torque) {
  Model* model = state_->models.find(name);
  const int index = linkIndex(model, link);
  return index >= 0 && pushLink(state_->view, *model, index, force, torque);
}

bool World::apply(const Wrench& wrench) {
  const Model* model = state_->models.find(wrench.model);
  if (linkIndex(model, wrench.link) < 0 || model->isStatic()) return false;
  state_->external_inputs.wrenches.push_back(wrench);
  return true;
}

bool World::apply(const Effort& effort) {
  const Model* model = state_->models.find(effort.model);
  if (!model || findJoint(*model, effort.joint) < 0 || model->joints.empty()) return false;
  state_->external_inputs.efforts.push_back(effort);
  return true;
}

void World::clearWrenches(const std::string& model, const std::string& link) {
  auto& all = state_->external_inputs.wrenches;
  const auto on = [&](const Wrench& w) { return w.model == model && w.link == link; };
  all.erase(std::remove_if(all.begin(), all.end(), on), all.end());
}

void World::clearEfforts(const std::string& model, const std::string& joint) {
  auto& all = state_->external_inputs.efforts;
  const auto on = [&](const Effort& e) { return e.model == model && e.joint == joint; };
  all.erase(std::remove_if(all.begin(), all.end(), on), all.end());
}

void World::setLight(const Light& light) { state_->external_inputs.lights[light.name] = light; }

bool World::removeLight(const std::string& name) {
  return state_->external_inputs.lights.erase(name) > 0;
}

void World::setOde(const OdeSettings& settings) { state_->external_inputs.ode = settings; }

}  // namespace kiva
