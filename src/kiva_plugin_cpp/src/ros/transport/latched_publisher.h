// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

#include "direct_publisher.h"
#include "subscriber_counts.h"

namespace kiva_ros {

/// A DirectPublisher that sends its last message to each new subscriber. roscpp would serialise
/// each message for that, even without a new subscriber.
template <typename Message>
class LatchedPublisher {
 public:
  LatchedPublisher() = default;
  /// `count` is called with +1 or -1 as subscribers connect and disconnect. `node` is a copy, as in
  /// advertiseCounted().
  LatchedPublisher(ros::NodeHandle node, const std::string& topic, int queue_size,
                   const std::function<void(int)>& count)
      : last_(std::make_shared<Last>()) {
    const auto welcome = [last = last_, count](const ros::SingleSubscriberPublisher& newcomer) {
      count(+1);
      const std::lock_guard<std::mutex> lock(last->mutex);
      if (last->message) newcomer.publish(*last->message);
    };
    const auto part = [count](const ros::SingleSubscriberPublisher&) { count(-1); };
    constexpr bool kLatched = true;  // as new subscribers are informed
    publisher_ = DirectPublisher(
        node.advertise<Message>(topic, queue_size, welcome, part, ros::VoidConstPtr(), kLatched));
  }

  void publish(Message message) {
    // Ensures that a new subscriber never gets an older message last.
    const std::lock_guard<std::mutex> lock(last_->mutex);
    publisher_.add(message);
    publisher_.flush();
    last_->message = std::move(message);
  }

 private:
  struct Last {
    std::mutex mutex;
    std::optional<Message> message;
  };

  std::shared_ptr<Last> last_;  ///< Shared with subscribers that connect while the topic ends.
  DirectPublisher publisher_;
};

}  // namespace kiva_ros
