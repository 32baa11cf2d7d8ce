// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/message_traits.h>
#include <ros/publication.h>
#include <ros/ros.h>
#include <ros/serialization.h>
#include <ros/topic_manager.h>

#include <utility>
#include <vector>

#include "subscriber_sockets.h"

namespace kiva_ros {

/// Publishes on one of thousands of topics, or many messages, from a single thread; not latched.
/// For each message, roscpp compares the names of all topics and wakes its own thread, which
/// searches all topics and makes four system calls to wait for the socket before it writes. With
/// ten thousand messages a second that is most of their cost. This class keeps the topic and writes
/// itself.
class DirectPublisher {
 public:
  DirectPublisher() = default;
  explicit DirectPublisher(const ros::Publisher& publisher)
      : publisher_(publisher),
        topic_(ros::TopicManager::instance()->lookupPublication(publisher_.getTopic())) {}

  template <typename Message>
  void publish(Message message) {
    add(message);
    flush();
  }
  /// Publishes with the next flush(): several messages become one write and one read. `message`
  /// gets its sequence number.
  template <typename Message>
  void add(Message& message) {
    if (!topic_) return;
    const std::uint32_t number = topic_->incrementSequence();
    if constexpr (ros::message_traits::HasHeader<Message>::value) message.header.seq = number;
    if (topic_->hasSubscribers()) added_.push_back(ros::serialization::serializeMessage(message));
  }
  void flush() {
    if (added_.empty()) return;
    writeToSubscribers(*topic_, added_);
    added_.clear();
  }

 private:
  ros::Publisher publisher_;
  ros::PublicationPtr topic_;
  std::vector<ros::SerializedMessage> added_;
};

}  // namespace kiva_ros
