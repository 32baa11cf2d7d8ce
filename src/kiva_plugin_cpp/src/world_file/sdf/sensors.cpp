// SPDX-License-Identifier: Apache-2.0
#include "world_file/sdf/sensors.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "world_file/elements/elements.h"
#include "world_file/elements/frames.h"
#include "world_file/elements/values.h"

namespace kiva {
namespace {

/// SDF's types of sensors, each with its own element, if it has one.
const std::map<std::string, std::string> kSensors = {{"air_pressure", "air_pressure"},
                                                     {"altimeter", "altimeter"},
                                                     {"boundingbox", "camera"},
                                                     {"boundingbox_camera", "camera"},
                                                     {"camera", "camera"},
                                                     {"contact", ""},
                                                     {"custom", ""},
                                                     {"depth", "camera"},
                                                     {"depth_camera", "camera"},
                                                     {"force_torque", "force_torque"},
                                                     {"gps", ""},
                                                     {"gpu_lidar", ""},
                                                     {"gpu_ray", ""},
                                                     {"imu", "imu"},
                                                     {"lidar", ""},
                                                     {"logical_camera", ""},
                                                     {"magnetometer", "magnetometer"},
                                                     {"multicamera", ""},
                                                     {"navsat", ""},
                                                     {"none", ""},
                                                     {"ray", ""},
                                                     {"rfid", ""},
                                                     {"rfidtag", ""},
                                                     {"rgbd", "camera"},
                                                     {"rgbd_camera", "camera"},
                                                     {"segmentation", "camera"},
                                                     {"segmentation_camera", "camera"},
                                                     {"sonar", ""},
                                                     {"thermal", "camera"},
                                                     {"thermal_camera", "camera"},
                                                     {"wireless_receiver", ""},
                                                     {"wireless_transmitter", ""}};

SensorDescription describeSensor(const XmlElement& from, const Scope& scope,
                                 const std::string& link) {
  const std::string type = attributeOf(from, "type");
  const auto kind = kSensors.find(type);
  if (kind == kSensors.end()) failAt(from, "there is no sensor of type '" + type + "' in SDF");
  SensorDescription sensor;
  sensor.name = attributeOf(from, "name");
  sensor.type = type;
  sensor.link = link;
  sensor.pose_in_link = poseAround(from);
  const double rate = numberIn(from, "update_rate", 0);
  sensor.update_rate = std::isfinite(rate) ? std::max(0.0, rate) : 0;
  sensor.parameters = readParameters(from, scope.origin.where);
  if (!kind->second.empty()) addMissing(from, kind->second, &sensor.parameters);
  sensor.plugins = readPlugins(from, scope.origin.where);
  return sensor;
}

void setColour(const XmlElement& light, const char* name, double* to) {
  const auto colour = readColour(contentOf(light.FirstChildElement(name)));
  if (colour) std::copy(colour->begin(), colour->end(), to);
}

}  // namespace

void addSensors(const XmlElement& link, const Scope& scope, ModelDescription* description,
                Faults* warnings) {
  forEach(link, "sensor", [&](const XmlElement& sensor) {
    buildOrLeaveOut("sensor", warnings, [&] {
      description->sensors.push_back(
          describeSensor(sensor, scope, scope.prefix + attributeOf(link, "name")));
    });
  });
}

Light describeLight(const XmlElement& from, const Pose& pose) {
  Light light;
  light.name = attributeOf(from, "name");
  const std::string type = attributeOf(from, "type");
  if (type == "spot") light.kind = Light::Kind::kSpot;
  if (type == "directional") light.kind = Light::Kind::kDirectional;
  light.pose = pose;
  std::fill_n(light.specular, 3, static_cast<float>(0.1));
  setColour(from, "diffuse", light.diffuse);
  setColour(from, "specular", light.specular);
  light.attenuation_linear = 1;
  if (const XmlElement* const fades = from.FirstChildElement("attenuation")) {
    light.attenuation_constant = numberIn(*fades, "constant", 1);
    light.attenuation_linear = numberIn(*fades, "linear", 1);
    light.attenuation_quadratic = numberIn(*fades, "quadratic", 0);
  }
  light.direction = vectorIn(from, "direction", Vector3(0, 0, -1));
  light.cast_shadows = flagIn(from, "cast_shadows", false);
  return light;
}

}  // namespace kiva
