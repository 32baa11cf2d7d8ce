// SPDX-License-Identifier: Apache-2.0
#include "direct_topic.h"

#include <ros/callback_queue.h>
#include <ros/publication.h>
#include <ros/subscriber_link.h>
#include <ros/topic_manager.h>

#include <boost/make_shared.hpp>
#include <cstdint>
#include <cstring>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "direct_link.h"
#include "private_member.h"

namespace kiva_ros {
namespace {

struct Links {
  using Type = ros::V_SubscriberLink ros::Publication::*;
  friend Type memberOf(Links);
};
struct LinksMutex {
  using Type = boost::mutex ros::Publication::*;
  friend Type memberOf(LinksMutex);
};
template struct PrivateMember<Links, &ros::Publication::subscriber_links_>;
template struct PrivateMember<LinksMutex, &ros::Publication::subscriber_links_mutex_>;

constexpr std::size_t kLengthBytes = 4;  // before a message; its header begins with the sequence

/// A copy, since sending to one that has gone takes it out of the list.
ros::V_SubscriberLink linksOf(ros::Publication& publication) {
  const boost::mutex::scoped_lock lock(publication.*memberOf(LinksMutex()));
  return publication.*memberOf(Links());
}

/// What who comes later is sent first.
struct Latch {
  std::mutex mutex;
  ros::SerializedMessage last;  ///< Guarded by mutex.
};

}  // namespace

class DirectTopic::Topic {
 public:
  Topic(const ros::AdvertiseOptions& options, const Count& count)
      : name_(options.topic),
        latch_(options.latch ? std::make_shared<Latch>() : nullptr),
        callbacks_(boost::make_shared<ros::SubscriberCallbacks>()) {
    callbacks_->callback_queue_ = ros::getGlobalCallbackQueue();
    if (count) {
      callbacks_->connect_ = [count](const ros::SingleSubscriberPublisher&) { count(+1); };
      callbacks_->disconnect_ = [count](const ros::SingleSubscriberPublisher&) { count(-1); };
    }
    if (latch_) {
      callbacks_->push_latched_message_ = [latch = latch_](const ros::SubscriberLinkPtr& link) {
        const std::lock_guard<std::mutex> lock(latch->mutex);
        if (latch->last.buf) link->enqueueMessage(latch->last, true, true);
      };
    }
    if (ros::TopicManager::instance()->advertise(options, callbacks_)) {
      publication_ = ros::TopicManager::instance()->lookupPublication(name_);
    }
  }
  ~Topic() {
    if (publication_) ros::TopicManager::instance()->unadvertise(name_, callbacks_);
  }

  bool isWanted() const { return publication_ && (latch_ || publication_->hasSubscribers()); }

  void send(ros::SerializedMessage message) {
    const std::uint32_t sequence = publication_->incrementSequence();
    std::memcpy(message.buf.get() + kLengthBytes, &sequence, sizeof sequence);
    // Held meanwhile, so that who comes now gets no message that is older than the one after it.
    std::unique_lock<std::mutex> lock;
    if (latch_) {
      lock = std::unique_lock<std::mutex>(latch_->mutex);
      latch_->last = message;
    }
    for (const ros::SubscriberLinkPtr& link : linksOf(*publication_)) sendDirectly(link, message);
  }

 private:
  const std::string name_;
  const std::shared_ptr<Latch> latch_;  ///< None: not latched.
  const ros::SubscriberCallbacksPtr callbacks_;
  ros::PublicationPtr publication_;
};

DirectTopic::DirectTopic(const ros::AdvertiseOptions& options, const Count& count)
    : topic_(std::make_shared<Topic>(options, count)) {}

bool DirectTopic::isWanted() const { return topic_ && topic_->isWanted(); }

void DirectTopic::send(ros::SerializedMessage message) const { topic_->send(std::move(message)); }

}  // namespace kiva_ros
