// SPDX-License-Identifier: Apache-2.0
#include "core/contact/external_wrenches.h"

#include <algorithm>

#include "core/motion/joints/joints.h"
#include "core/state/places/poses.h"

namespace kiva {
namespace {

constexpr double kRounding = 1e-9;  // [s] of simulated time

bool hasBegun(const Period& period, double now) { return now >= period.start - kRounding; }
bool isOver(const Period& period, double now) { return now >= period.end - kRounding; }

void apply(ContactView& world, const Wrench& wrench) {
  Model* model = world.models.find(wrench.model);
  const int link = model ? linkIndex(*model->description, wrench.link) : -1;
  if (link >= 0) pushLink(world, *model, link, wrench.force, wrench.torque);
}

void apply(ContactView& world, const Effort& effort) {
  Model* model = world.models.find(effort.model);
  const int joint = model && !model->joints.empty() ? findJoint(*model, effort.joint) : -1;
  if (joint >= 0) pushJoint(*model, joint, effort.effort);
}

template <typename Input>
void applyDue(ContactView& world, std::vector<Input>* all) {
  if (all->empty()) return;
  const double now = world.clock.time();
  for (const Input& one : *all) {
    if (hasBegun(one.period, now) && !isOver(one.period, now)) apply(world, one);
  }
  const auto over = [now](const Input& one) { return isOver(one.period, now); };
  all->erase(std::remove_if(all->begin(), all->end(), over), all->end());
}

template <typename Input>
void forget(const std::string& model, std::vector<Input>* all) {
  const auto of = [&](const Input& one) { return one.model == model; };
  all->erase(std::remove_if(all->begin(), all->end(), of), all->end());
}

}  // namespace

void applyExternalWrenches(ContactView& world) {
  applyDue(world, &world.external_inputs.wrenches);
  applyDue(world, &world.external_inputs.efforts);
}

bool pushLink(ContactView& world, Model& model, int link, const Vector3& force,
              const Vector3& torque) {
  if (model.isStatic()) return false;
  const Link& description = model.description->links[link];
  const Vector3 at = (linkPose(world, model, link) * description.inertial_pose_in_link).Pos();
  return model.owner->push(world, model, link, at, force, torque);
}

void forgetExternalInputs(ExternalInputs& external_inputs, const std::string& model) {
  forget(model, &external_inputs.wrenches);
  forget(model, &external_inputs.efforts);
}

}  // namespace kiva
