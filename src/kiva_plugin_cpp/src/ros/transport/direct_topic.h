// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>
#include <ros/serialization.h>

#include <functional>
#include <memory>
#include <string>

namespace kiva_ros {

/// One topic of thousands, or one with thousands of messages a second. For each message roscpp
/// compares the names of all topics, wakes its thread, has that look at each topic's queue, and
/// tells the kernel twice what to wait for at that socket: several times the cost of sending it.
/// This keeps the topic at hand and writes to its sockets from the thread that publishes; what a
/// slow subscriber has no room for waits in roscpp's queue, as ever. Latched topics stay so.
/// Of messages with a header. One thread publishes.
class DirectTopic {
 public:
  using Count = std::function<void(int)>;  ///< Called with +1 or -1 as subscribers come and go.

  DirectTopic() = default;
  template <typename Message>
  static DirectTopic advertise(const ros::NodeHandle& node, const std::string& topic,
                               int queue_size, bool latched = false, const Count& count = {}) {
    static_assert(ros::message_traits::HasHeader<Message>::value, "its sequence is counted");
    ros::AdvertiseOptions options;
    options.init<Message>(node.resolveName(topic), queue_size);
    options.latch = latched;
    return DirectTopic(options, count);
  }

  template <typename Message>
  void publish(const Message& message) const {
    if (isWanted()) send(ros::serialization::serializeMessage(message));
  }

 private:
  class Topic;

  DirectTopic(const ros::AdvertiseOptions& options, const Count& count);
  bool isWanted() const;
  void send(ros::SerializedMessage message) const;

  std::shared_ptr<Topic> topic_;  ///< Advertised as long as somebody holds it.
};

}  // namespace kiva_ros
