// SPDX-License-Identifier: Apache-2.0
#include "world_file/sensors.h"

#include <algorithm>
#include <cmath>
#include <sdf/Sensor.hh>

#include "world_file/elements.h"
#include "world_file/errors.h"
#include "world_file/from_sdformat.h"

namespace kiva {
namespace {

SensorDescription describeSensor(const sdf::Sensor& from, const Scope& scope,
                                 const std::string& link) {
  SensorDescription sensor;
  sensor.name = from.Name();
  sensor.type = from.Element()->Get<std::string>("type");
  sensor.link = link;
  sensor.pose_in_link = resolved(from.SemanticPose(), from.Element());
  sensor.update_rate = std::isfinite(from.UpdateRate()) ? std::max(0.0, from.UpdateRate()) : 0;
  sensor.parameters = readParameters(from.Element(), scope.origin.where);
  sensor.plugins = readPlugins(from.Element(), scope.origin.where);
  return sensor;
}

void copy(const ignition::math::Color& from, double* to) {
  const float values[] = {from.R(), from.G(), from.B(), from.A()};
  std::copy(std::begin(values), std::end(values), to);
}

}  // namespace

void addSensors(const sdf::Link& link, const Scope& scope, ModelDescription* description,
                sdf::Errors* warnings) {
  for (uint64_t i = 0; i < link.SensorCount(); ++i) {
    buildOrLeaveOut("sensor", warnings, [&] {
      description->sensors.push_back(
          describeSensor(*link.SensorByIndex(i), scope, scope.prefix + link.Name()));
    });
  }
}

Light describeLight(const sdf::Light& from, const Pose& pose) {
  Light light;
  light.name = from.Name();
  if (from.Type() == sdf::LightType::SPOT) light.kind = Light::Kind::kSpot;
  if (from.Type() == sdf::LightType::DIRECTIONAL) light.kind = Light::Kind::kDirectional;
  light.pose = pose;
  copy(from.Diffuse(), light.diffuse);
  copy(from.Specular(), light.specular);
  light.attenuation_constant = from.ConstantAttenuationFactor();
  light.attenuation_linear = from.LinearAttenuationFactor();
  light.attenuation_quadratic = from.QuadraticAttenuationFactor();
  light.direction = fromSdformat(from.Direction());
  light.cast_shadows = from.CastShadows();
  return light;
}

}  // namespace kiva
