// SPDX-License-Identifier: Apache-2.0
#include "ros/services/models/state_services.h"

#include "ros/messages/convert.h"
#include "ros/messages/reference_frames.h"
#include "ros/services/base/service_answer.h"

namespace kiva_ros {
namespace {

constexpr int kSetModelQueue = 10;

bool isNested(const std::string& name) { return name.find("::") != std::string::npos; }

void describe(const kiva::ModelDescription& model,
              gazebo_msgs::GetModelProperties::Response* response) {
  response->is_static = model.is_static;
  if (!model.links.empty()) response->canonical_body_name = model.links.front().name;
  for (const kiva::Link& link : model.links) {
    if (isNested(link.name)) continue;
    response->body_names.push_back(link.name);
    for (const auto& collision : link.collisions) response->geom_names.push_back(collision.name);
  }
  for (const kiva::Joint& joint : model.joints) {
    if (!isNested(joint.name)) response->joint_names.push_back(joint.name);
  }
  for (const std::string& name : model.nested_models) {
    if (!isNested(name)) response->child_model_names.push_back(name);
  }
}

/// Returns a state in world relative to `frame`. Throws ServiceRefusal if there is no such frame.
kiva::EntityState seenFrom(const kiva::World& world, const std::string& frame_name,
                           const kiva::EntityState& state, const std::string& no_frame) {
  const auto frame = frameState(world, frame_name);
  if (!frame) throw ServiceRefusal(no_frame);
  return relativeTo(*frame, state);
}

}  // namespace

StateServices::StateServices(ros::NodeHandle& root, ros::NodeHandle& node,
                             SimulationThread& simulation)
    : simulation_(simulation) {
  servers_ = {root.advertiseService("get_model_state", &StateServices::getModel, this),
              node.advertiseService("get_model_state", &StateServices::getModel, this),
              node.advertiseService("get_model_properties", &StateServices::getProperties, this),
              serveCommand(node, "set_model_state", &StateServices::setModel, this)};
  set_model_ = node.subscribe("set_model_state", kSetModelQueue, &StateServices::setModelByTopic,
                              this, ros::TransportHints().tcpNoDelay());
}

bool StateServices::getModel(gazebo_msgs::GetModelState::Request& request,
                             gazebo_msgs::GetModelState::Response& response) {
  return answer("GetModelState", response, [&] {
    simulation_.run([&](kiva::World& world) {
      const auto state = world.state(request.model_name);
      if (!state) throw ServiceRefusal("GetModelState: model does not exist");
      const kiva::EntityState relative =
          seenFrom(world, request.relative_entity_name, *state,
                   "GetModelState: reference relative_entity_name not found, did you forget to "
                   "scope the body by model name?");
      response.header = header(world.time(), request.relative_entity_name);
      response.header.seq = ++asked_[request.model_name];
      response.pose = toMessage(relative.pose);
      response.twist = toMessage(relative.twist);
    });
    return "GetModelState: got properties";
  });
}

bool StateServices::getProperties(gazebo_msgs::GetModelProperties::Request& request,
                                  gazebo_msgs::GetModelProperties::Response& response) {
  return answer("GetModelProperties", response, [&] {
    const auto model =
        simulation_.run([&](kiva::World& world) { return world.description(request.model_name); });
    if (!model) throw ServiceRefusal("GetModelProperties: model does not exist");
    describe(*model, &response);
    return "GetModelProperties: got properties";
  });
}

bool StateServices::setModel(const gazebo_msgs::SetModelState::Request& request,
                             gazebo_msgs::SetModelState::Response& response) {
  return answer("SetModelState", response, [&] {
    const gazebo_msgs::ModelState& asked = request.model_state;
    const kiva::EntityState in_frame = fromMessage(asked);
    simulation_.move([&](kiva::World& world) {
      if (!world.has(asked.model_name)) throw ServiceRefusal("SetModelState: model does not exist");
      const auto frame = frameState(world, asked.reference_frame);
      if (!frame) {
        throw ServiceRefusal("SetModelState: specified reference frame entity does not exist");
      }
      world.setState(asked.model_name, inWorld(*frame, in_frame));
    });
    return "SetModelState: set model state done";
  });
}

void StateServices::setModelByTopic(const gazebo_msgs::ModelState& state) {
  gazebo_msgs::SetModelState call;
  call.request.model_state = state;
  setModel(call.request, call.response);
  if (!call.response.success) {
    ROS_WARN_THROTTLE(1, "%s (%s)", call.response.status_message.c_str(), state.model_name.c_str());
  }
}

}  // namespace kiva_ros
