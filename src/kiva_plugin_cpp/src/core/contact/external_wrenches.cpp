// SPDX-License-Identifier: Apache-2.0
#include "core/contact/external_wrenches.h"

#include <algorithm>

#include "core/contact/activation.h"
#include "core/contact/joints.h"
#include "core/models/load.h"
#include "core/models/models.h"
#include "core/motion/cruise.h"
#include "core/motion/drives.h"

namespace kiva {
namespace {

constexpr double kRounding = 1e-9;  // [s] of simulated time

bool hasBegun(const Period& period, double now) { return now >= period.start - kRounding; }
bool isOver(const Period& period, double now) { return now >= period.end - kRounding; }

int linkIndex(const Model& model, const std::string& name) {
  const auto& links = model.description->links;
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (links[i].name == name) return static_cast<int>(i);
  }
  return -1;
}

void apply(WorldState& world, const Wrench& wrench) {
  const Model* model = world.find(wrench.model);
  const int link = model ? linkIndex(*model, wrench.link) : -1;
  if (link >= 0)
    pushLink(world, world.slot_of_name.at(model->name), link, wrench.force, wrench.torque);
}

void apply(WorldState& world, const Effort& effort) {
  Model* model = world.find(effort.model);
  const int joint = model && !model->joints.empty() ? findJoint(*model, effort.joint) : -1;
  if (joint >= 0) pushJoint(*model, joint, effort.effort);
}

template <typename Intervention>
void applyDue(WorldState& world, std::vector<Intervention>* all) {
  if (all->empty()) return;
  const double now = world.time();
  for (const Intervention& one : *all) {
    if (hasBegun(one.period, now) && !isOver(one.period, now)) apply(world, one);
  }
  const auto over = [now](const Intervention& one) { return isOver(one.period, now); };
  all->erase(std::remove_if(all->begin(), all->end(), over), all->end());
}

bool pushBody(LinkBody& link, const Vector3& force, const Vector3& torque) {
  link.body->activate(true);
  link.body->applyCentralForce(toBullet(force));
  link.body->applyTorque(toBullet(torque));
  return true;
}

/// The wheels' grip answers in the same step.
bool pushRobot(WorldState& world, int robot, const Vector3& at, const Vector3& force,
               const Vector3& torque) {
  Fleet& f = world.fleet;
  const Vehicle vehicle = vehicleOf(f.robots[robot], groundOf(world));
  const Vector3 centre = centreFromOrigin(f, robot);
  const Vector3 arm = at - basePose(world, robot).Pos() - centre;
  const double turn = (torque + arm.Cross(force)).Z() / vehicle.inertia * world.dt;
  f.awake[robot] = 1;
  stopCruise(f, robot);
  f.vx[robot] += force.X() / vehicle.mass * world.dt + turn * centre.Y();
  f.vy[robot] += force.Y() / vehicle.mass * world.dt - turn * centre.X();
  f.yaw_rate[robot] += turn;
  return true;
}

template <typename Intervention>
void forget(const std::string& model, std::vector<Intervention>* all) {
  const auto of = [&](const Intervention& one) { return one.model == model; };
  all->erase(std::remove_if(all->begin(), all->end(), of), all->end());
}

}  // namespace

void applyExternalWrenches(WorldState& world) {
  applyDue(world, &world.external_inputs.wrenches);
  applyDue(world, &world.external_inputs.efforts);
}

bool pushLink(WorldState& world, int slot, int link, const Vector3& force, const Vector3& torque) {
  Model& model = *world.models[slot];
  if (model.isStatic()) return false;
  const Link& description = model.description->links[link];
  const Vector3 at = (linkPose(world, model, link) * description.inertial_pose_in_link).Pos();
  if (model.kind == ModelKind::kRobot) return pushRobot(world, model.index, at, force, torque);
  if (model.kind == ModelKind::kItem && world.items[model.index].unit >= 0) {
    return pushLink(world, world.units[world.items[model.index].unit].model, 0, force, torque);
  }
  if (model.kind == ModelKind::kStorageUnit) {
    const int carrier = world.units[model.index].carrier;
    if (carrier >= 0) return pushRobot(world, carrier, at, force, torque);
    letFall(world, model);
  }
  if (link >= static_cast<int>(model.bodies.links.size())) return false;
  return pushBody(model.bodies.links[link], force, torque);
}

void forgetExternalInputs(WorldState& world, const std::string& model) {
  forget(model, &world.external_inputs.wrenches);
  forget(model, &world.external_inputs.efforts);
}

}  // namespace kiva
