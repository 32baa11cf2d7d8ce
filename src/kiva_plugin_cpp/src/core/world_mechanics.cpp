// SPDX-License-Identifier: Apache-2.0
#include <algorithm>
#include <stdexcept>

#include "core/contact/external_wrenches.h"
#include "core/models/models.h"
#include "core/motion/joints/joints.h"
#include "core/state/world_state.h"
#include "kiva_plugin_cpp/world.h"

namespace kiva {

std::optional<JointState> World::joint(const std::string& model, const std::string& joint) const {
  const Model* found = state_->models.find(model);
  const int index = found ? findJoint(*found, joint) : -1;
  if (index < 0) return std::nullopt;
  return jointState(state_->view.fleet, *found, index);
}

std::optional<JointWrench> World::jointWrench(const std::string& model,
                                              const std::string& joint) const {
  const Model* found = state_->models.find(model);
  const int index = found ? findJoint(*found, joint) : -1;
  if (index < 0) return std::nullopt;
  return kiva::jointWrench(*found, index);
}

bool World::setJoint(const std::string& model, const std::string& joint,
                     const JointSettings& settings) {
  Model* found = state_->models.find(model);
  const int index = found ? findJoint(*found, joint) : -1;
  if (index < 0) return false;
  kiva::setJoint(*found, index, settings);
  return true;
}

void World::setJointPositions(const std::string& model,
                              const std::map<std::string, double>& positions) {
  Model* found = state_->models.find(model);
  if (!found) throw std::invalid_argument("there is no model '" + model + "'");
  placeJoints(state_->view, *found, positions);
}

const ExternalInputs& World::externalInputs() const { return state_->external_inputs; }

bool World::applyWrench(const std::string& model, const std::string& link, const Vector3& force,
                        const Vector3& torque) {
  Model* found = state_->models.find(model);
  const int index = linkIndex(found, link);
  return index >= 0 && pushLink(state_->view, *found, index, force, torque);
}

bool World::apply(const Wrench& wrench) {
  const Model* found = state_->models.find(wrench.model);
  if (linkIndex(found, wrench.link) < 0 || found->isStatic()) return false;
  state_->external_inputs.wrenches.push_back(wrench);
  return true;
}

bool World::apply(const Effort& effort) {
  const Model* found = state_->models.find(effort.model);
  if (!found || findJoint(*found, effort.joint) < 0 || found->joints.empty()) return false;
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
