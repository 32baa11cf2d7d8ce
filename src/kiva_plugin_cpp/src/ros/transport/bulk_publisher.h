// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/publication.h>
#include <ros/ros.h>
#include <ros/serialization.h>
#include <ros/topic_manager.h>

#include <utility>

namespace kiva_ros {

/// One topic of thousands. roscpp compares the names of all topics for each message, and wakes its
/// thread for it, which for ten thousand messages a second is most of their cost. This keeps the
/// topic at hand; that thread sends what was published when it wakes next (Sockets::wake()).
class BulkPublisher {
 public:
  BulkPublisher() = default;
  explicit BulkPublisher(ros::Publisher publisher)
      : publisher_(std::move(publisher)),
        publication_(ros::TopicManager::instance()->lookupPublication(publisher_.getTopic())) {}

  /// roscpp's own way: sent at once and, where the topic is, latched.
  const ros::Publisher& publisher() const { return publisher_; }

  template <typename Message>
  void publish(const Message& message) const {
    if (!publication_ || !publication_->hasSubscribers()) return;
    ros::SerializedMessage serialized = ros::serialization::serializeMessage(message);
    publication_->publish(serialized);
  }

 private:
  ros::Publisher publisher_;
  ros::PublicationPtr publication_;
};

}  // namespace kiva_ros
