// SPDX-License-Identifier: Apache-2.0
#include "ros/services/models/link_services.h"

#include <gazebo_msgs/ApplyBodyWrench.h>
#include <gazebo_msgs/BodyRequest.h>
#include <gazebo_msgs/GetLinkProperties.h>
#include <gazebo_msgs/GetLinkState.h>
#include <gazebo_msgs/SetLinkProperties.h>
#include <gazebo_msgs/SetLinkState.h>

#include <cmath>

#include "kiva_plugin_cpp/principal_inertia.h"
#include "ros/messages/convert.h"
#include "ros/messages/reference_frames.h"
#include "ros/services/base/action_period.h"
#include "ros/services/base/service_answer.h"

namespace kiva_ros {
namespace {

using kiva::Matrix3;

constexpr int kSetLinkQueue = 10;

/// Returns the model and the link that a name means. Throws ServiceRefusal with that text if there
/// is no such link.
ScopedName linkNamed(const kiva::World& world, const std::string& name,
                     const std::string& no_link) {
  const auto entity = findEntity(world, name);
  if (!entity || entity->second.empty()) throw ServiceRefusal(no_link);
  return *entity;
}

kiva::EntityState frameNamed(const kiva::World& world, const std::string& name,
                             const std::string& no_frame) {
  const auto frame = frameState(world, name);
  if (!frame) throw ServiceRefusal(no_frame);
  return *frame;
}

std::string notFound(const std::string& label, const char* what) {
  return label + ": " + what + " not found, did you forget to scope the link by model name?";
}

gazebo_msgs::LinkState getState(const kiva::World& world,
                                const gazebo_msgs::GetLinkState::Request& request) {
  const std::string label = "GetLinkState";
  const auto [model, link] = linkNamed(world, request.link_name, notFound(label, "link"));
  const auto frame =
      frameNamed(world, request.reference_frame, notFound(label, "reference reference_frame"));
  const kiva::EntityState relative = relativeTo(frame, *world.state(model, link));
  gazebo_msgs::LinkState out;
  out.link_name = request.link_name;
  out.reference_frame = request.reference_frame;
  out.pose = toMessage(relative.pose);
  out.twist = toMessage(relative.twist);
  return out;
}

void setState(kiva::World& world, const gazebo_msgs::LinkState& asked) {
  const auto [model, link] = linkNamed(world, asked.link_name, "SetLinkState: link does not exist");
  const auto frame = frameNamed(
      world, asked.reference_frame,
      "SetLinkState: failed, there is no reference frame '" + asked.reference_frame + "'");
  const kiva::EntityState in_frame{fromMessage(asked.pose), fromMessage(asked.twist)};
  world.setLinkState(model, link, inWorld(frame, in_frame));
}

/// Fills in a link's mass, gravity flag and inertia; the tensor is about the centre of mass, along
/// the link's axes.
void describe(const kiva::Link& link, gazebo_msgs::GetLinkProperties::Response* out) {
  const Matrix3 turn(link.inertial_pose_in_link.Rot());
  const kiva::Vector3& m = link.principal_moments;
  const Matrix3 tensor = turn * Matrix3(m.X(), 0, 0, 0, m.Y(), 0, 0, 0, m.Z()) * turn.Transposed();
  out->com = toMessage(kiva::Pose(link.inertial_pose_in_link.Pos(), kiva::Quaternion::Identity));
  out->gravity_mode = link.gravity;
  out->mass = link.mass;
  out->ixx = tensor(0, 0);
  out->ixy = tensor(0, 1);
  out->ixz = tensor(0, 2);
  out->iyy = tensor(1, 1);
  out->iyz = tensor(1, 2);
  out->izz = tensor(2, 2);
}

/// Throws ServiceRefusal unless a value is finite and within the limits of the physics.
void checkNumber(double value, double most, const char* what) {
  if (std::abs(value) <= most) return;
  throw ServiceRefusal("SetLinkProperties: " + std::string(what) + " must be finite and at most " +
                       std::to_string(static_cast<long long>(most)));
}

kiva::Link likeRequest(const std::string& name,
                       const gazebo_msgs::SetLinkProperties::Request& request) {
  constexpr double kMostMass = 1e9;      // [kg]
  constexpr double kMostInertia = 1e12;  // [kg m²]
  checkNumber(request.mass, kMostMass, "mass");
  for (double value :
       {request.ixx, request.ixy, request.ixz, request.iyy, request.iyz, request.izz}) {
    checkNumber(value, kMostInertia, "an inertia");
  }
  const kiva::InertiaTensor tensor{{request.ixx, request.iyy, request.izz},
                                   {request.ixy, request.ixz, request.iyz}};
  kiva::Link like;
  like.name = name;
  like.mass = request.mass;
  like.gravity = request.gravity_mode;
  like.principal_moments = tensor.principalMoments();
  like.inertial_pose_in_link =
      fromMessage(request.com) * kiva::Pose(kiva::Vector3::Zero, tensor.principalAxes());
  return like;
}

/// Applies a wrench. In an inertial frame the force acts at the centre of mass, displaced by the
/// reference point; in the frame of a link or a model, at the point in that frame.
kiva::Wrench wrenchOf(const kiva::World& world,
                      const gazebo_msgs::ApplyBodyWrench::Request& request) {
  const auto [model, link] =
      linkNamed(world, request.body_name, "ApplyBodyWrench: body does not exist");
  if (world.description(model)->is_static) {
    throw ServiceRefusal("ApplyBodyWrench: body is static and does not move");
  }
  const auto frame =
      frameNamed(world, request.reference_frame, "ApplyBodyWrench: reference_frame not found");
  const kiva::Quaternion& turn = frame.pose.Rot();
  const kiva::Vector3 point = fromMessage(request.reference_point, "reference_point");
  kiva::Vector3 arm = point;
  if (!isInertial(request.reference_frame)) {
    const kiva::Pose centre = world.state(model, link)->pose *
                              world.description(model)->findLink(link)->inertial_pose_in_link;
    arm = frame.pose.CoordPositionAdd(point) - centre.Pos();
  }
  kiva::Wrench out;
  out.model = model;
  out.link = link;
  out.force = turn.RotateVector(fromMessage(request.wrench.force, "force"));
  out.torque =
      turn.RotateVector(fromMessage(request.wrench.torque, "torque")) + arm.Cross(out.force);
  checkSize(out.force.Length() + out.torque.Length(), "wrench");
  out.period = periodOf(world, request.start_time, request.duration);
  return out;
}

}  // namespace

LinkServices::LinkServices(ros::NodeHandle& node, SimulationThread& simulation)
    : simulation_(simulation) {
  using namespace gazebo_msgs;
  servers_.push_back(serve<GetLinkState>(
      node, "get_link_state", "GetLinkState", [&simulation](auto& request, auto& response) {
        response.link_state =
            simulation.run([&](kiva::World& world) { return getState(world, request); });
        return "GetLinkState: got state";
      }));
  servers_.push_back(serveChange<SetLinkState>(
      node, "set_link_state", "SetLinkState", [&simulation](auto& request, auto&) {
        simulation.move([&](kiva::World& world) { setState(world, request.link_state); });
        return "SetLinkState: success";
      }));
  servers_.push_back(serve<GetLinkProperties>(
      node, "get_link_properties", "GetLinkProperties",
      [&simulation](auto& request, auto& response) {
        simulation.run([&](kiva::World& world) {
          const auto [model, link] =
              linkNamed(world, request.link_name, notFound("GetLinkProperties", "link"));
          describe(*world.description(model)->findLink(link), &response);
        });
        return "GetLinkProperties: got properties";
      }));
  servers_.push_back(serveChange<SetLinkProperties>(
      node, "set_link_properties", "SetLinkProperties", [&simulation](auto& request, auto&) {
        simulation.change([&](kiva::World& world) {
          const auto [model, link] =
              linkNamed(world, request.link_name, notFound("SetLinkProperties", "link"));
          world.setLinkInertia(model, likeRequest(link, request));
        });
        return "SetLinkProperties: properties set";
      }));
  servers_.push_back(serveChange<ApplyBodyWrench>(
      node, "apply_body_wrench", "ApplyBodyWrench", [&simulation](auto& request, auto&) {
        simulation.change([&](kiva::World& world) { world.apply(wrenchOf(world, request)); });
        return "ApplyBodyWrench: wrench set";
      }));
  servers_.push_back(serveCommand<BodyRequest::Request, BodyRequest::Response>(
      node, "clear_body_wrenches", [&simulation](auto& request, auto&) {
        simulation.post([&simulation, body = request.body_name](kiva::World& world) {
          simulation.noteChange();
          const auto [model, link] = findEntity(world, body).value_or(splitScoped(body));
          world.clearWrenches(model, link);
        });
        return true;
      }));
  set_link_ = node.subscribe("set_link_state", kSetLinkQueue, &LinkServices::setByTopic, this,
                             ros::TransportHints().tcpNoDelay());
}

void LinkServices::setByTopic(const gazebo_msgs::LinkState& state) {
  gazebo_msgs::SetLinkState::Response response;
  answer("SetLinkState", response, [&] {
    simulation_.move([&](kiva::World& world) { setState(world, state); });
    return "";
  });
  if (!response.success) {
    ROS_WARN_THROTTLE(1, "%s (%s)", response.status_message.c_str(), state.link_name.c_str());
  }
}

}  // namespace kiva_ros
