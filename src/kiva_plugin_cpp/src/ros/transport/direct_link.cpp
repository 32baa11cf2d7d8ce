// SPDX-License-Identifier: Apache-2.0
#include "direct_link.h"

#include <ros/connection.h>
#include <ros/transport/transport_tcp.h>
#include <ros/transport_subscriber_link.h>

#include <boost/thread/mutex.hpp>
#include <cstdint>
#include <cstring>
#include <queue>

#include "private_member.h"

namespace kiva_ros {
namespace {

using Link = ros::TransportSubscriberLink;

struct Outbox {
  using Type = std::queue<ros::SerializedMessage> Link::*;
  friend Type memberOf(Outbox);
};
struct OutboxMutex {
  using Type = boost::mutex Link::*;
  friend Type memberOf(OutboxMutex);
};
struct HeaderWritten {
  using Type = bool Link::*;
  friend Type memberOf(HeaderWritten);
};
struct WritingMessage {
  using Type = bool Link::*;
  friend Type memberOf(WritingMessage);
};
struct OnMessageWritten {
  using Type = void (Link::*)(const ros::ConnectionPtr&);
  friend Type memberOf(OnMessageWritten);
};
struct Stats {
  using Type = ros::SubscriberLink::Stats ros::SubscriberLink::*;
  friend Type memberOf(Stats);
};
template struct PrivateMember<Outbox, &Link::outbox_>;
template struct PrivateMember<OutboxMutex, &Link::outbox_mutex_>;
template struct PrivateMember<HeaderWritten, &Link::header_written_>;
template struct PrivateMember<WritingMessage, &Link::writing_message_>;
template struct PrivateMember<OnMessageWritten, &Link::onMessageWritten>;
template struct PrivateMember<Stats, &ros::SubscriberLink::stats_>;

/// Whether nothing is being written there; if so, from now on the caller writes.
bool begin(Link& link) {
  const boost::mutex::scoped_lock lock(link.*memberOf(OutboxMutex()));
  bool& writing = link.*memberOf(WritingMessage());
  if (writing || !(link.*memberOf(HeaderWritten())) || !(link.*memberOf(Outbox())).empty()) {
    return false;
  }
  writing = true;
  return true;
}

void count(Link& link, std::uint32_t bytes) {
  ros::SubscriberLink::Stats& stats = link.*memberOf(Stats());
  ++stats.messages_sent_;
  stats.bytes_sent_ += bytes;
  stats.message_data_sent_ += bytes;
}

/// roscpp's thread writes what is left once there is room.
void leaveRest(const boost::shared_ptr<Link>& link, const ros::SerializedMessage& message,
               std::uint32_t sent) {
  const std::uint32_t left = static_cast<std::uint32_t>(message.num_bytes) - sent;
  const boost::shared_array<std::uint8_t> rest(new std::uint8_t[left]);
  std::memcpy(rest.get(), message.buf.get() + sent, left);
  const auto written = [link = link.get()](const ros::ConnectionPtr& connection) {
    (link->*memberOf(OnMessageWritten()))(connection);
  };
  link->getConnection()->write(rest, left, written, false);
}

}  // namespace

void sendDirectly(const ros::SubscriberLinkPtr& link, const ros::SerializedMessage& message) {
  const auto socket = boost::dynamic_pointer_cast<Link>(link);
  auto* const tcp =
      socket ? dynamic_cast<ros::TransportTCP*>(socket->getConnection()->getTransport().get())
             : nullptr;
  if (!tcp || !begin(*socket)) {
    link->enqueueMessage(message, true, false);
    return;
  }
  const auto size = static_cast<std::uint32_t>(message.num_bytes);
  const std::int32_t sent = tcp->write(message.buf.get(), size);
  if (sent < 0) return;  // it has gone, and roscpp has dropped it
  count(*socket, size);
  if (static_cast<std::uint32_t>(sent) < size) {
    leaveRest(socket, message, static_cast<std::uint32_t>(sent));
  } else {  // and roscpp goes on with what came meanwhile
    ((*socket).*memberOf(OnMessageWritten()))(socket->getConnection());
  }
}

}  // namespace kiva_ros
