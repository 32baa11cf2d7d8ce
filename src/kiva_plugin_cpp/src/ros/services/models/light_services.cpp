// SPDX-License-Identifier: Apache-2.0
#include "ros/services/models/light_services.h"

#include <gazebo_msgs/DeleteLight.h>
#include <gazebo_msgs/GetLightProperties.h>
#include <gazebo_msgs/SetLightProperties.h>

#include <cmath>

#include "ros/messages/convert.h"
#include "ros/services/base/service_answer.h"

namespace kiva_ros {
namespace {

kiva::Light lightNamed(const kiva::World& world, const std::string& name,
                       const std::string& label) {
  const auto& lights = world.externalInputs().lights;
  const auto light = lights.find(name);
  if (light == lights.end()) {
    throw ServiceRefusal(label + ": Requested light " + name + " not found!");
  }
  return light->second;
}

void copy(const std_msgs::ColorRGBA& from, const char* what, double* to) {
  const float values[] = {from.r, from.g, from.b, from.a};
  for (int i = 0; i < 4; ++i) {
    if (!std::isfinite(values[i])) throw std::invalid_argument(std::string(what) + " not finite");
    to[i] = values[i];
  }
}

double attenuation(double value) {
  if (std::isfinite(value) && value >= 0) return value;
  throw std::invalid_argument("an attenuation must be finite and not negative");
}

void describe(const kiva::Light& light, gazebo_msgs::GetLightProperties::Response* out) {
  out->diffuse.r = static_cast<float>(light.diffuse[0]);
  out->diffuse.g = static_cast<float>(light.diffuse[1]);
  out->diffuse.b = static_cast<float>(light.diffuse[2]);
  out->diffuse.a = static_cast<float>(light.diffuse[3]);
  out->attenuation_constant = light.attenuation_constant;
  out->attenuation_linear = light.attenuation_linear;
  out->attenuation_quadratic = light.attenuation_quadratic;
}

void set(kiva::World& world, const gazebo_msgs::SetLightProperties::Request& request) {
  kiva::Light light = lightNamed(world, request.light_name, "SetLightProperties");
  copy(request.diffuse, "diffuse", light.diffuse);
  copy(request.specular, "specular", light.specular);
  light.cast_shadows = request.cast_shadows;
  light.attenuation_constant = attenuation(request.attenuation_constant);
  light.attenuation_linear = attenuation(request.attenuation_linear);
  light.attenuation_quadratic = attenuation(request.attenuation_quadratic);
  light.direction = fromMessage(request.direction, "direction");
  light.pose = fromMessage(request.pose);
  world.setLight(light);
}

}  // namespace

LightServices::LightServices(ros::NodeHandle& node, SimulationThread& simulation) {
  using namespace gazebo_msgs;
  servers_.push_back(serve<GetLightProperties>(
      node, "get_light_properties", "GetLightProperties",
      [&simulation](auto& request, auto& response) {
        simulation.run([&](kiva::World& world) {
          describe(lightNamed(world, request.light_name, "GetLightProperties"), &response);
        });
        return "GetLightProperties: got properties";
      }));
  servers_.push_back(serveChange<SetLightProperties>(
      node, "set_light_properties", "SetLightProperties", [&simulation](auto& request, auto&) {
        simulation.change([&](kiva::World& world) { set(world, request); });
        return "SetLightProperties: properties set";
      }));
  servers_.push_back(serveChange<DeleteLight>(
      node, "delete_light", "DeleteLight", [&simulation](auto& request, auto&) {
        simulation.change([&](kiva::World& world) {
          if (!world.removeLight(request.light_name)) {
            throw ServiceRefusal("DeleteLight: Requested light " + request.light_name +
                                 " not found!");
          }
        });
        return "DeleteLight: " + request.light_name + " successfully deleted";
      }));
}

}  // namespace kiva_ros
