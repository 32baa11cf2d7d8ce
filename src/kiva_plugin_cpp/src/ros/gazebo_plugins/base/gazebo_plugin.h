// SPDX-License-Identifier: Apache-2.0
//
// Shared by the stand-ins for gazebo_ros' plugins. They run on the step thread; the broadcaster
// publishes the messages that they queue.
#pragma once

#include <ros/ros.h>

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include "kiva_plugin_cpp/plugin.h"
#include "kiva_plugin_cpp/world.h"
#include "ros/gazebo_plugins/base/plugin_inputs.h"
#include "ros/transport/publish_queue.h"

namespace kiva_ros {

/// A model that publishes a frame, by one of its plugins.
struct FrameOwner {
  std::string model;
  const void* plugin = nullptr;
};

/// The owners of frames, by the frames' names.
using FrameOwners = std::map<std::string, FrameOwner>;

struct PluginContext {
  ros::NodeHandle& root;
  PublishQueue& publish_queue;
  PluginInputs& inputs;
  std::shared_ptr<FrameOwners> frames;
  const kiva::SensorDescription* sensor;  ///< Null for a plugin of a model.
};

/// Decides when a message is due at a rate of simulated time, also after a reset of time.
class Schedule {
 public:
  /// `rate` [Hz]; 0 = every step.
  explicit Schedule(double rate = 0) : period_(rate > 0 ? 1 / rate : 0) {}
  bool isDue(double now);

 private:
  double period_;
  double next_ = 0, last_ = 0;
};

/// Returns the lower of two rates [Hz], where 0 = every step.
double slower(double a, double b);

/// Returns normally distributed noise with mean 0 and deviation 1. It depends on the arguments
/// alone, so that a run can be repeated from any moment.
double noise(std::uint64_t seed, std::uint64_t step, std::uint64_t index);

class GazeboPlugin : public kiva::Plugin {
 public:
  explicit GazeboPlugin(const PluginContext& context)
      : root_(context.root),
        publish_queue_(context.publish_queue),
        inputs_(context.inputs),
        frames_(context.frames),
        sensor_(context.sensor) {}
  bool isStrict() const override { return false; }

 protected:
  /// Reads `robotNamespace`; topics are in it from now on. Each plugin of gazebo_ros has namespaces
  /// of its own where that is missing or empty.
  void enter(const kiva::World& world, const std::string& model, const kiva::Parameters& parameters,
             const std::string& if_missing, const std::string& if_empty);
  /// Marks parameters of Gazebo's plugin as known that have no use here.
  static void skip(const kiva::Parameters& parameters, std::initializer_list<const char*> keys);
  /// Returns a frame's name with the tf prefix of this namespace. `prefix_by_namespace`: without
  /// the parameter tf_prefix the namespace itself is the prefix.
  std::string frame(const std::string& name, bool prefix_by_namespace = false) const;
  /// Returns the text of a required parameter. Throws DescriptionError if it is missing or empty.
  static std::string required(const kiva::Parameters& parameters, const std::string& key);
  /// Returns the sensor of this plugin. Throws DescriptionError if it has not that type.
  const kiva::SensorDescription& sensor(const kiva::Parameters& parameters,
                                        const std::string& types) const;
  /// Returns a link's name; `key` holds it with or without its model's name. Throws
  /// DescriptionError if there is no such link.
  std::string link(const kiva::Parameters& parameters, const std::string& key) const;
  /// Returns the movable joint named at `key`. Throws DescriptionError if there is none.
  std::string joint(const kiva::World& world, const kiva::Parameters& parameters,
                    const std::string& key, const std::string& fallback) const;
  /// Returns `vector` with noise of that deviation added; `index` distinguishes the quantities that
  /// are measured in one step.
  kiva::Vector3 noisy(const kiva::World& world, const kiva::Vector3& vector, double deviation,
                      std::uint64_t index) const;

  ros::NodeHandle& node() { return *node_; }
  FrameOwners& frames() { return *frames_; }
  const std::string& model() const { return model_; }
  const kiva::ModelDescription& description() const { return *description_; }
  std::uint64_t seed() const { return seed_; }

  /// Throws std::runtime_error if this program publishes another type on that topic.
  template <typename Message>
  ros::Publisher advertise(const std::string& topic, int queue = 10) {
    if (topic.empty()) throw kiva::DescriptionError("a topic's name is empty");
    const ros::Publisher publisher = node_->advertise<Message>(topic, queue);
    if (publisher) return publisher;
    throw kiva::DescriptionError("topic '" + node_->resolveName(topic) +
                                 "' is published with another type");
  }
  /// Returns the name of a topic that all robots of the world share, whatever their namespaces.
  std::string shared(const std::string& topic) const { return root_.resolveName(topic); }
  template <typename Message>
  PluginInput<Message> subscribe(const std::string& topic) {
    return inputs_.subscribe<Message>(node(), topic);
  }
  template <typename Message>
  void publish(const ros::Publisher& publisher, Message message) {
    publish_queue_.post([publisher, message = std::move(message)] { publisher.publish(message); });
  }

 private:
  ros::NodeHandle& root_;
  PublishQueue& publish_queue_;
  PluginInputs& inputs_;
  const std::shared_ptr<FrameOwners> frames_;
  const kiva::SensorDescription* sensor_;
  std::unique_ptr<ros::NodeHandle> node_;
  std::string namespace_, model_;
  std::shared_ptr<const kiva::ModelDescription> description_;
  std::uint64_t seed_ = 0;
};

}  // namespace kiva_ros
