// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/signals2/connection.hpp>
#include <condition_variable>
#include <cstdint>
#include <mutex>

namespace kiva_ros {

/// Waits for the thread of roscpp that writes the messages which publishers queue.
class PollThread {
 public:
  PollThread();
  ~PollThread();
  /// Returns when that thread has written all earlier messages to sockets.
  void flush();

 private:
  std::mutex mutex_;
  std::condition_variable turned_;
  std::uint64_t turns_ = 0;  ///< Turns of that thread; guarded by mutex_.
  boost::signals2::connection connection_;
};

}  // namespace kiva_ros
