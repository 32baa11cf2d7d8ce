// SPDX-License-Identifier: Apache-2.0
//
// What plugins subscribe to. The newest message of a topic takes effect at the beginning of the
// next step, for all plugins that subscribe to it, so that a recording knows when it did.
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

/// One topic, whatever its type; on the step thread but where said otherwise.
class InputTopic {
 public:
  virtual ~InputTopic() = default;
  /// Makes the newest message the one that holds. Whether there was one.
  virtual bool advance() = 0;
  /// Forgets what came since the last step.
  virtual void discard() = 0;
  /// The message that holds, into a recording.
  virtual void write(rosbag::Bag& bag, const ros::Time& stamp) const = 0;
  /// Lets a recorded message come.
  virtual void replay(const rosbag::MessageInstance& recorded) = 0;
};

template <typename Message>
class TypedInputTopic : public InputTopic {
 public:
  using Pointer = boost::shared_ptr<const Message>;

  /// `name`: resolved. `live`: whether it subscribes; in a replay it does not.
  TypedInputTopic(ros::NodeHandle& node, const std::string& name, bool live) : name_(name) {
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
    bag.write(name_, stamp, *current_);
  }
  void replay(const rosbag::MessageInstance& recorded) override {
    if (const auto message = recorded.instantiate<Message>()) receive(message);
  }

  const Pointer& current() const { return current_; }
  std::uint64_t revision() const { return revision_; }  ///< Counts up with each advance.

 private:
  /// In any thread.
  void receive(const Pointer& message) {
    const std::lock_guard<std::mutex> lock(mutex_);
    newest_ = message;
  }

  const std::string name_;
  std::mutex mutex_;
  Pointer newest_;  ///< Guarded by mutex_.
  Pointer current_;
  std::uint64_t revision_ = 0;
  ros::Subscriber subscriber_;  ///< The last: no message comes to what is half destroyed.
};

/// One plugin's view of a topic.
template <typename Message>
class PluginInput {
 public:
  PluginInput() = default;
  explicit PluginInput(std::shared_ptr<TypedInputTopic<Message>> topic)
      : topic_(std::move(topic)), seen_(topic_->revision()) {}

  /// The message that holds since this step began; null if none came since the last call.
  const Message* take() {
    if (!topic_ || topic_->revision() == seen_) return nullptr;
    seen_ = topic_->revision();
    return topic_->current().get();
  }

 private:
  std::shared_ptr<TypedInputTopic<Message>> topic_;
  std::uint64_t seen_ = 0;
};

/// All topics that plugins subscribe to. Must outlive the plugins.
class PluginInputs : public StepHook {
 public:
  /// `live`: false where a replay takes the place of those who publish.
  explicit PluginInputs(bool live) : live_(live) {}

  /// Throws std::runtime_error if another plugin has that topic with another type.
  template <typename Message>
  PluginInput<Message> subscribe(ros::NodeHandle& node, const std::string& topic);

  /// Called with each topic on which a message takes effect at the step to come.
  void onMessage(std::function<void(std::shared_ptr<const InputTopic>)> call) {
    on_message_ = std::move(call);
  }
  /// Lets a recorded message come, if a plugin subscribes to its topic.
  void replay(const rosbag::MessageInstance& recorded);

  bool beforeStep(kiva::World& world) override;
  void beforeReset(kiva::World& world) override;

 private:
  void forEach(const std::function<void(const std::shared_ptr<InputTopic>&)>& act);

  const bool live_;
  std::map<std::string, std::weak_ptr<InputTopic>> topics_;  ///< By resolved name.
  std::function<void(std::shared_ptr<const InputTopic>)> on_message_;
};

template <typename Message>
PluginInput<Message> PluginInputs::subscribe(ros::NodeHandle& node, const std::string& topic) {
  const std::string name = node.resolveName(topic);
  std::weak_ptr<InputTopic>& slot = topics_[name];
  if (const auto known = slot.lock()) {
    const auto same = std::dynamic_pointer_cast<TypedInputTopic<Message>>(known);
    if (!same) throw std::runtime_error("topic " + name + " is subscribed to with another type");
    return PluginInput<Message>(same);
  }
  const auto made = std::make_shared<TypedInputTopic<Message>>(node, name, live_);
  slot = made;
  return PluginInput<Message>(made);
}

}  // namespace kiva_ros
