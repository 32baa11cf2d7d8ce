// SPDX-License-Identifier: Apache-2.0
#include "ros/services/models/joint_services.h"

#include <gazebo_msgs/ApplyJointEffort.h>
#include <gazebo_msgs/GetJointProperties.h>
#include <gazebo_msgs/JointRequest.h>
#include <gazebo_msgs/SetJointProperties.h>
#include <gazebo_msgs/SetModelConfiguration.h>

#include <cmath>
#include <map>
#include <utility>

#include "ros/messages/reference_frames.h"
#include "ros/services/base/action_period.h"
#include "ros/services/base/service_answer.h"

namespace kiva_ros {
namespace {

using Properties = gazebo_msgs::GetJointProperties::Response;

std::pair<std::string, std::string> jointNamed(const kiva::World& world, const std::string& name,
                                               const std::string& label) {
  const auto joint = findJoint(world, name);
  if (!joint) throw ServiceRefusal(label + ": joint not found");
  return *joint;
}

std::uint8_t typeOf(kiva::Joint::Kind kind) {
  switch (kind) {
    case kiva::Joint::Kind::kRevolute:
      return Properties::REVOLUTE;
    case kiva::Joint::Kind::kContinuous:
      return Properties::CONTINUOUS;
    case kiva::Joint::Kind::kPrismatic:
      return Properties::PRISMATIC;
    case kiva::Joint::Kind::kBall:
      return Properties::BALL;
    default:
      return Properties::FIXED;
  }
}

void describe(const kiva::World& world, const std::string& name, Properties* out) {
  const auto [model, joint] = jointNamed(world, name, "GetJointProperties");
  const kiva::JointState state = *world.joint(model, joint);
  const kiva::Joint::Kind kind = world.description(model)->findJoint(joint)->kind;
  out->type = typeOf(kind);
  if (kind == kiva::Joint::Kind::kBall) return;  // It has no axis.
  out->damping = {state.settings.damping};
  out->position = {state.position};
  out->rate = {state.rate};
}

/// Reads the first value of a list with one value an axis; our joints have one axis.
void read(const std::vector<double>& values, double* out) {
  if (!values.empty()) *out = values.front();
}

/// Sets a joint. ODE's fmax and vel become a motor; Bullet has no equivalent of its other settings.
std::string configure(kiva::World& world, const gazebo_msgs::SetJointProperties::Request& request) {
  const auto [model, joint] = jointNamed(world, request.joint_name, "SetJointProperties");
  const gazebo_msgs::ODEJointProperties& ode = request.ode_joint_config;
  kiva::JointSettings settings = world.joint(model, joint)->settings;
  read(ode.damping, &settings.damping);
  read(ode.hiStop, &settings.upper);
  read(ode.loStop, &settings.lower);
  read(ode.fmax, &settings.motor_effort);
  read(ode.vel, &settings.motor_speed);
  world.setJoint(model, joint, settings);
  std::string ignored;
  const std::pair<const char*, bool> unused[] = {{"erp", !ode.erp.empty()},
                                                 {"cfm", !ode.cfm.empty()},
                                                 {"stop_erp", !ode.stop_erp.empty()},
                                                 {"stop_cfm", !ode.stop_cfm.empty()},
                                                 {"fudge_factor", !ode.fudge_factor.empty()}};
  for (const auto& [name, is_given] : unused) {
    if (is_given) ignored += (ignored.empty() ? "" : ", ") + std::string(name);
  }
  const std::string done = "SetJointProperties: properties set";
  return ignored.empty() ? done : done + "; without effect here: " + ignored;
}

void pose(kiva::World& world, const gazebo_msgs::SetModelConfiguration::Request& request) {
  if (!world.has(request.model_name)) {
    throw ServiceRefusal("SetModelConfiguration: model does not exist");
  }
  if (request.joint_names.size() != request.joint_positions.size()) {
    throw ServiceRefusal(
        "SetModelConfiguration: joint name and position list have different lengths");
  }
  std::map<std::string, double> positions;
  for (std::size_t i = 0; i < request.joint_names.size(); ++i) {
    const auto [model, joint] = splitScoped(request.joint_names[i]);
    const bool is_scoped = model == request.model_name && !joint.empty();
    positions[is_scoped ? joint : request.joint_names[i]] = request.joint_positions[i];
  }
  world.setJointPositions(request.model_name, positions);
}

void push(kiva::World& world, const gazebo_msgs::ApplyJointEffort::Request& request) {
  const auto [model, joint] = jointNamed(world, request.joint_name, "ApplyJointEffort");
  if (!std::isfinite(request.effort))
    throw ServiceRefusal("ApplyJointEffort: effort is not finite");
  checkSize(std::abs(request.effort), "effort");
  const kiva::Period period = periodOf(world, request.start_time, request.duration);
  if (!world.apply(kiva::Effort{model, joint, request.effort, period})) {
    throw ServiceRefusal("ApplyJointEffort: joint '" + joint + "' of '" + model +
                         "' can't be pushed: its model is static, or its plugins drive it");
  }
}

}  // namespace

JointServices::JointServices(ros::NodeHandle& node, SimulationThread& simulation) {
  using namespace gazebo_msgs;
  servers_.push_back(serve<GetJointProperties>(node, "get_joint_properties", "GetJointProperties",
                                               [&simulation](auto& request, auto& response) {
                                                 simulation.run([&](kiva::World& world) {
                                                   describe(world, request.joint_name, &response);
                                                 });
                                                 return "GetJointProperties: got properties";
                                               }));
  servers_.push_back(serveChange<SetJointProperties>(
      node, "set_joint_properties", "SetJointProperties", [&simulation](auto& request, auto&) {
        return simulation.change([&](kiva::World& world) { return configure(world, request); });
      }));
  servers_.push_back(serveChange<SetModelConfiguration>(
      node, "set_model_configuration", "SetModelConfiguration",
      [&simulation](auto& request, auto&) {
        simulation.move([&](kiva::World& world) { pose(world, request); });
        return "SetModelConfiguration: success";
      }));
  servers_.push_back(serveChange<ApplyJointEffort>(
      node, "apply_joint_effort", "ApplyJointEffort", [&simulation](auto& request, auto&) {
        simulation.change([&](kiva::World& world) { push(world, request); });
        return "ApplyJointEffort: effort set";
      }));
  servers_.push_back(serveCommand<JointRequest::Request, JointRequest::Response>(
      node, "clear_joint_forces", [&simulation](auto& request, auto&) {
        simulation.post([&simulation, name = request.joint_name](kiva::World& world) {
          simulation.noteChange();
          if (const auto joint = findJoint(world, name)) {
            world.clearEfforts(joint->first, joint->second);
          }
        });
        return true;
      }));
}

}  // namespace kiva_ros
