// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace kiva_ros {

/// Sets roscpp's server socket up for many clients and for messages that do not wait. Call it after
/// ros::start().
///
/// - A thousand clients, or one with a thousand topics, may connect at the same time. roscpp's
///   server queues five connections; further clients try again after 1 s, then 3 s, up to a minute.
/// - No connection that it accepts uses Nagle's algorithm. With it a message that follows another
///   shortly waits until the client's system has acknowledged the first, 40 ms on Linux. Clients
///   can ask for that (`tcp_nodelay`), but rospy's own subscriber of /clock does not.
void tuneServerSocket();

}  // namespace kiva_ros
