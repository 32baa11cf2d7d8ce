// SPDX-License-Identifier: Apache-2.0
//
// The topics that plugins subscribe to. The newest message of a topic takes effect at the beginning
// of the next step, for all plugins that subscribe to it, so that a recording knows the step.
#pragma once

#include <ros/ros.h>
#include <rosbag/bag.h>
#include <rosbag/message_instance.h>

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <utility>

#include "ros/simulation/step_hook.h"

namespace kiva_ros {

/// A topic of any type. Used on the step thread, except where noted.
class InputTopic {
 public:
  virtual ~InputTopic() = default;
  /// Makes the newest message the current one. Returns whether there was one.
  virtual bool advance() = 0;
  /// Discards the messages since the last step.
  virtual void discard() = 0;
  /// Writes the current message into a recording.
  virtual void write(rosbag::Bag& bag, const ros::Time& stamp) const = 0;
  /// Receives a recorded message.
  virtual void replay(const rosbag::MessageInstance& recorded) = 0;
};

template <typename Message>
class TypedInputTopic : public InputTopic {
 public:
  using Pointer = boost::shared_ptr<const Message>;

  /// `recorded_as`: its name in a recording. `live`: whether to subscribe; a replay does not.
  /// `node` is a copy, since a handle remembers each subscription ever made by it.
  TypedInputTopic(ros::NodeHandle node, const std::string& name, const std::string& recorded_as,
                  bool live)
      : recorded_as_(recorded_as) {
    if (!live) return;
    const boost::function<void(const Pointer&)> keep = [this](const Pointer& m) { receive(m); };
    subscriber_ = node.subscribe<Message>(name, 1, keep, ros::VoidConstPtr(),
                                          ros::TransportHints().tcpNoDelay());
  }

  bool advance() override {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!newest_) return false;
    current_ = std::exchange(newest_, nullptr);
    ++revision_;
    return true;
  }
  void discard() override { receive(nullptr); }
  void write(rosbag::Bag& bag, const ros::Time& stamp) const override {
    bag.write(recorded_as_, stamp, *current_);
  }
  void replay(const rosbag::MessageInstance& recorded) override {
    if (const auto message = recorded.instantiate<Message>()) receive(message);
  }

  const Pointer& current() const { return current_; }
  std::uint64_t revision() const { return revision_; }  ///< Grows with each advance.

 private:
  /// Receives a message, in any thread.
  void receive(const Pointer& message) {
    const std::lock_guard<std::mutex> lock(mutex_);
    newest_ = message;
  }

  const std::string recorded_as_;
  std::mutex mutex_;
  Pointer newest_;  ///< Guarded by mutex_.
  Pointer current_;
  std::uint64_t revision_ = 0;
  ros::Subscriber subscriber_;  ///< Declared last, destroyed first: no message comes meanwhile.
};

/// A plugin's subscription to a topic.
template <typename Message>
class PluginInput {
 public:
  PluginInput() = default;
  explicit PluginInput(std::shared_ptr<TypedInputTopic<Message>> topic)
      : topic_(std::move(topic)), taken_revision_(topic_->revision()) {}

  /// Returns the message that took effect at this step; null if no message came since the last
  /// call.
  const Message* take() {
    if (!topic_ || topic_->revision() == taken_revision_) return nullptr;
    taken_revision_ = topic_->revision();
    return topic_->current().get();
  }

 private:
  std::shared_ptr<TypedInputTopic<Message>> topic_;
  std::uint64_t taken_revision_ = 0;
};

/// Holds all topics that plugins subscribe to. Must outlive the plugins.
class PluginInputs : public StepHook {
 public:
  /// `live`: false in a replay, which replaces the publishers.
  explicit PluginInputs(bool live) : live_(live) {}

  /// Returns a topic. Throws std::runtime_error if another plugin uses it with another type.
  template <typename Message>
  PluginInput<Message> subscribe(ros::NodeHandle& node, const std::string& topic);

  /// Sets a function to call with each topic on which a message takes effect at the next step.
  void onMessage(std::function<void(std::shared_ptr<const InputTopic>)> call) {
    on_message_ = std::move(call);
  }
  /// Receives a recorded message, if a plugin subscribes to its topic.
  void replay(const rosbag::MessageInstance& recorded);

  bool beforeStep(kiva::World& world) override;
  void beforeReset(kiva::World& world) override;

 private:
  void forEach(const std::function<void(const std::shared_ptr<InputTopic>&)>& act);

  const bool live_;
  std::map<std::string, std::weak_ptr<InputTopic>> topics_;  ///< By their names in a recording.
  std::function<void(std::shared_ptr<const InputTopic>)> on_message_;
};

/// Returns the name of a topic as if its world were in no namespace: recordings store no
/// namespaces.
std::string withoutNamespace(const std::string& resolved);

template <typename Message>
PluginInput<Message> PluginInputs::subscribe(ros::NodeHandle& node, const std::string& topic) {
  const std::string name = node.resolveName(topic), recorded_as = withoutNamespace(name);
  std::weak_ptr<InputTopic>& slot = topics_[recorded_as];
  if (const auto known = slot.lock()) {
    const auto same = std::dynamic_pointer_cast<TypedInputTopic<Message>>(known);
    if (!same) throw std::runtime_error("topic " + name + " is subscribed to with another type");
    return PluginInput<Message>(same);
  }
  const auto made = std::make_shared<TypedInputTopic<Message>>(node, name, recorded_as, live_);
  slot = made;
  return PluginInput<Message>(made);
}

}  // namespace kiva_ros
