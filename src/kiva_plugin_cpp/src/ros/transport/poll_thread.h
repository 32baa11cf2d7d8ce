// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/signals2/connection.hpp>
#include <condition_variable>
#include <cstdint>
#include <mutex>

namespace kiva_ros {

/// Lets a thousand clients, or one with a thousand topics, connect at once. roscpp lets five wait
/// at its server; who finds no room tries again after 1 s, then 3 s, up to a minute. After
/// ros::start().
void raiseListenBacklog();

/// roscpp only queues what is published; a thread of its own writes it.
class PollThread {
 public:
  PollThread();
  ~PollThread();
  /// Lets that thread write what BulkTopics published.
  void wake();
  /// Returns when that thread has handed all that was published before to the sockets.
  void flush();

 private:
  std::mutex mutex_;
  std::condition_variable turned_;
  std::uint64_t turns_ = 0;  ///< Of that thread; guarded by mutex_.
  boost::signals2::connection connection_;
};

}  // namespace kiva_ros
