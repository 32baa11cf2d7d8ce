// SPDX-License-Identifier: Apache-2.0
#include "ros/gazebo_plugins/base/gazebo_plugin.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "ros/messages/reference_frames.h"

namespace kiva_ros {
namespace {

constexpr double kRounding = 1e-9;  // [s]

std::string withoutSlashes(std::string text) {
  while (!text.empty() && text.back() == '/') text.pop_back();
  const std::size_t first = text.find_first_not_of('/');
  return first == std::string::npos ? "" : text.substr(first);
}

/// Mixes a number (SplitMix64, Steele et al., 2014).
std::uint64_t mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 27)) * 0x94d049bb133111eb;
  return x ^ (x >> 31);
}

/// Returns a number in (0, 1].
double uniform(std::uint64_t bits) { return (static_cast<double>(bits >> 11) + 1) * 0x1p-53; }

}  // namespace

bool Schedule::isDue(double now) {
  if (now < last_) next_ = now;
  last_ = now;
  if (now < next_ - kRounding) return false;
  next_ += period_;
  if (next_ <= now)
    next_ = now + period_;  // after a late start, or with a step longer than the period
  return true;
}

double slower(double a, double b) {
  if (a <= 0 || b <= 0) return std::max(a, b);
  return std::min(a, b);
}

double noise(std::uint64_t seed, std::uint64_t step, std::uint64_t index) {
  const std::uint64_t one = mix(mix(mix(seed) ^ step) ^ index);
  return std::sqrt(-2 * std::log(uniform(one))) * std::cos(2 * M_PI * uniform(mix(one)));
}

void GazeboPlugin::enter(const kiva::World& world, const std::string& model,
                         const kiva::Parameters& parameters, const std::string& if_missing,
                         const std::string& if_empty) {
  model_ = model;
  description_ = world.description(model);
  if (!description_) {
    throw kiva::DescriptionError("it is a plugin of a model, not of a world");
  }
  namespace_ = parameters.text("robotNamespace", if_missing);
  if (namespace_.empty() && parameters.has("robotNamespace")) namespace_ = if_empty;
  node_ = std::make_unique<ros::NodeHandle>(root_, withoutSlashes(namespace_));
  const std::string name = model + (sensor_ ? sensor_->link + sensor_->name : "");
  seed_ = world.seed() ^ std::hash<std::string>()(name);
}

void GazeboPlugin::skip(const kiva::Parameters& parameters,
                        std::initializer_list<const char*> keys) {
  for (const char* key : keys) parameters.text(key, "");
}

std::string GazeboPlugin::frame(const std::string& name, bool prefix_by_namespace) const {
  std::string key, prefix;
  if (node_->searchParam("tf_prefix", key)) node_->getParam(key, prefix);
  if (prefix.empty() && prefix_by_namespace) prefix = namespace_;
  prefix = withoutSlashes(prefix);
  if (!name.empty() && name[0] == '/') return name.substr(1);
  return prefix.empty() ? name : prefix + "/" + name;
}

std::string GazeboPlugin::required(const kiva::Parameters& parameters, const std::string& key) {
  std::string text = parameters.text(key, "");
  if (text.empty()) throw kiva::DescriptionError("<" + key + "> is missing or empty");
  return text;
}

const kiva::SensorDescription& GazeboPlugin::sensor(const kiva::Parameters&,
                                                    const std::string& types) const {
  if (sensor_ && (" " + types + " ").find(" " + sensor_->type + " ") != std::string::npos) {
    return *sensor_;
  }
  throw kiva::DescriptionError("it belongs in a <sensor> of type " + types);
}

std::string GazeboPlugin::link(const kiva::Parameters& parameters, const std::string& key) const {
  const std::string name = parameters.text(key, "");
  const auto [scope, inner] = splitScoped(name);
  for (const std::string& tried : {name, scope == model_ ? inner : name}) {
    if (description_->findLink(tried)) return tried;
  }
  throw kiva::DescriptionError("<" + key + "> is '" + name + "', which is not a link of '" +
                               model_ + "'");
}

std::string GazeboPlugin::joint(const kiva::World& world, const kiva::Parameters& parameters,
                                const std::string& key, const std::string& fallback) const {
  std::string name = parameters.text(key, fallback);
  const kiva::Joint* joint = description_->findJoint(name);
  if (joint && joint->hasAxis() && world.joint(model_, name)) return name;
  throw kiva::DescriptionError("<" + key + "> is '" + name + "', which is not a joint of '" +
                               model_ + "' that moves");
}

kiva::Vector3 GazeboPlugin::noisy(const kiva::World& world, const kiva::Vector3& vector,
                                  double deviation, std::uint64_t index) const {
  kiva::Vector3 out = vector;
  if (deviation == 0) return out;
  for (int i = 0; i < 3; ++i) out[i] += deviation * noise(seed_, world.steps(), index + i);
  return out;
}

}  // namespace kiva_ros
