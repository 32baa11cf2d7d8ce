// SPDX-License-Identifier: Apache-2.0
#include "subscriber_sockets.h"

#include <ros/connection.h>
#include <ros/transport/transport_tcp.h>
#include <ros/transport_subscriber_link.h>
#include <sys/socket.h>
#include <sys/uio.h>

#include <algorithm>
#include <boost/bind/bind.hpp>
#include <queue>

#include "private_member.h"

namespace kiva_ros {

using Link = ros::TransportSubscriberLink;

struct TopicLinks {
  using Type = ros::V_SubscriberLink ros::Publication::*;
  friend Type memberOf(TopicLinks);
};
struct TopicLinksMutex {
  using Type = boost::mutex ros::Publication::*;
  friend Type memberOf(TopicLinksMutex);
};
struct LinkConnection {
  using Type = ros::ConnectionPtr Link::*;
  friend Type memberOf(LinkConnection);
};
struct IsHeaderWritten {
  using Type = bool Link::*;
  friend Type memberOf(IsHeaderWritten);
};
struct IsWritingMessage {
  using Type = bool Link::*;
  friend Type memberOf(IsWritingMessage);
};
struct LinkOutbox {
  using Type = std::queue<ros::SerializedMessage> Link::*;
  friend Type memberOf(LinkOutbox);
};
struct LinkOutboxMutex {
  using Type = boost::mutex Link::*;
  friend Type memberOf(LinkOutboxMutex);
};
struct OnMessageWritten {
  using Type = void (Link::*)(const ros::ConnectionPtr&);
  friend Type memberOf(OnMessageWritten);
};
struct TcpSocket {
  using Type = int ros::TransportTCP::*;
  friend Type memberOf(TcpSocket);
};
struct IsClosed {
  using Type = bool ros::TransportTCP::*;
  friend Type memberOf(IsClosed);
};
struct TcpCloseMutex {
  using Type = boost::recursive_mutex ros::TransportTCP::*;
  friend Type memberOf(TcpCloseMutex);
};
template struct PrivateMember<TopicLinks, &ros::Publication::subscriber_links_>;
template struct PrivateMember<TopicLinksMutex, &ros::Publication::subscriber_links_mutex_>;
template struct PrivateMember<LinkConnection, &Link::connection_>;
template struct PrivateMember<IsHeaderWritten, &Link::header_written_>;
template struct PrivateMember<IsWritingMessage, &Link::writing_message_>;
template struct PrivateMember<LinkOutbox, &Link::outbox_>;
template struct PrivateMember<LinkOutboxMutex, &Link::outbox_mutex_>;
template struct PrivateMember<OnMessageWritten, &Link::onMessageWritten>;
template struct PrivateMember<TcpSocket, &ros::TransportTCP::sock_>;
template struct PrivateMember<IsClosed, &ros::TransportTCP::closed_>;
template struct PrivateMember<TcpCloseMutex, &ros::TransportTCP::close_mutex_>;

namespace {

using Messages = std::vector<ros::SerializedMessage>;

constexpr std::size_t kMostParts = 64;  // of what one call writes

/// Returns how many bytes the socket took: none where it is full, or broken, which roscpp's thread
/// sees to.
std::size_t write(int socket, const Messages& messages) {
  iovec parts[kMostParts];
  msghdr all{};
  all.msg_iov = parts;
  all.msg_iovlen = std::min(messages.size(), kMostParts);
  for (std::size_t k = 0; k < all.msg_iovlen; ++k) {
    parts[k] = {messages[k].buf.get(), messages[k].num_bytes};
  }
  const ssize_t taken = sendmsg(socket, &all, MSG_DONTWAIT | MSG_NOSIGNAL);
  return taken < 0 ? 0 : static_cast<std::size_t>(taken);
}

/// roscpp's thread is to write a message from its byte `begin` on, as if it had begun itself.
void finish(Link& link, const ros::SerializedMessage& message, std::size_t begin) {
  link.*memberOf(IsWritingMessage()) = true;
  const boost::shared_array<std::uint8_t> rest(message.buf, message.buf.get() + begin);
  (link.*memberOf(LinkConnection()))
      ->write(rest, static_cast<std::uint32_t>(message.num_bytes - begin),
              boost::bind(memberOf(OnMessageWritten()), &link, boost::placeholders::_1), false);
}

/// Returns how many of the messages are on their way: none where roscpp's thread has to send others
/// first.
std::size_t writeNow(Link& link, const Messages& messages) {
  const ros::TransportPtr transport = (link.*memberOf(LinkConnection()))->getTransport();
  auto* tcp = dynamic_cast<ros::TransportTCP*>(transport.get());
  if (!tcp) return 0;
  // roscpp's thread holds the first while it looks after this socket, and takes the second then.
  const boost::recursive_mutex::scoped_lock open(tcp->*memberOf(TcpCloseMutex()));
  const boost::mutex::scoped_lock order(link.*memberOf(LinkOutboxMutex()));
  if (tcp->*memberOf(IsClosed()) || !(link.*memberOf(IsHeaderWritten()))) return 0;
  if (link.*memberOf(IsWritingMessage()) || !(link.*memberOf(LinkOutbox())).empty()) return 0;
  std::size_t bytes = write(tcp->*memberOf(TcpSocket()), messages), done = 0;
  while (done < messages.size() && bytes >= messages[done].num_bytes) {
    bytes -= messages[done++].num_bytes;
  }
  if (bytes > 0) finish(link, messages[done++], bytes);
  return done;
}

}  // namespace

void writeToSubscribers(ros::Publication& topic, const Messages& messages) {
  ros::V_SubscriberLink links;
  {
    const boost::mutex::scoped_lock lock(topic.*memberOf(TopicLinksMutex()));
    links = topic.*memberOf(TopicLinks());
  }
  for (const ros::SubscriberLinkPtr& link : links) {
    auto* remote = dynamic_cast<Link*>(link.get());  // none: of a subscriber in this process
    const std::size_t done = remote ? writeNow(*remote, messages) : 0;
    for (std::size_t k = done; k < messages.size(); ++k) {
      link->enqueueMessage(messages[k], true, false);
    }
  }
}

}  // namespace kiva_ros
