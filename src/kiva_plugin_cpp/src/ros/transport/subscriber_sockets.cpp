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

struct TopicLinks : PrivateMember<TopicLinks, ros::V_SubscriberLink ros::Publication::*> {};
struct TopicLinksMutex : PrivateMember<TopicLinksMutex, boost::mutex ros::Publication::*> {};
struct LinkConnection : PrivateMember<LinkConnection, ros::ConnectionPtr Link::*> {};
struct IsHeaderWritten : PrivateMember<IsHeaderWritten, bool Link::*> {};
struct IsWritingMessage : PrivateMember<IsWritingMessage, bool Link::*> {};
struct LinkOutbox : PrivateMember<LinkOutbox, std::queue<ros::SerializedMessage> Link::*> {};
struct LinkOutboxMutex : PrivateMember<LinkOutboxMutex, boost::mutex Link::*> {};
struct OnMessageWritten
    : PrivateMember<OnMessageWritten, void (Link::*)(const ros::ConnectionPtr&)> {};
struct TcpSocket : PrivateMember<TcpSocket, int ros::TransportTCP::*> {};
struct IsClosed : PrivateMember<IsClosed, bool ros::TransportTCP::*> {};
struct TcpCloseMutex : PrivateMember<TcpCloseMutex, boost::recursive_mutex ros::TransportTCP::*> {};
template struct Reveal<TopicLinks, &ros::Publication::subscriber_links_>;
template struct Reveal<TopicLinksMutex, &ros::Publication::subscriber_links_mutex_>;
template struct Reveal<LinkConnection, &Link::connection_>;
template struct Reveal<IsHeaderWritten, &Link::header_written_>;
template struct Reveal<IsWritingMessage, &Link::writing_message_>;
template struct Reveal<LinkOutbox, &Link::outbox_>;
template struct Reveal<LinkOutboxMutex, &Link::outbox_mutex_>;
template struct Reveal<OnMessageWritten, &Link::onMessageWritten>;
template struct Reveal<TcpSocket, &ros::TransportTCP::sock_>;
template struct Reveal<IsClosed, &ros::TransportTCP::closed_>;
template struct Reveal<TcpCloseMutex, &ros::TransportTCP::close_mutex_>;

namespace {

using Messages = std::vector<ros::SerializedMessage>;

constexpr std::size_t kMostParts = 64;  // buffers of one call

/// Returns how many bytes the socket took: 0 if it is full, or broken, which roscpp's thread
/// handles.
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

/// Returns how many of the messages were written, at least in part: 0 if roscpp's thread has to
/// send others first.
std::size_t writeNow(Link& link, const Messages& messages) {
  const ros::TransportPtr transport = (link.*memberOf(LinkConnection()))->getTransport();
  auto* tcp = dynamic_cast<ros::TransportTCP*>(transport.get());
  if (!tcp) return 0;
  // roscpp's thread holds the first lock while it handles this socket, and takes the second then.
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
    auto* remote = dynamic_cast<Link*>(link.get());  // null for a subscriber in this process
    const std::size_t done = remote ? writeNow(*remote, messages) : 0;
    for (std::size_t k = done; k < messages.size(); ++k) {
      link->enqueueMessage(messages[k], true, false);
    }
  }
}

}  // namespace kiva_ros
