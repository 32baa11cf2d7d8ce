// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost/signals2/connection.hpp>
#include <condition_variable>
#include <cstdint>
#include <mutex>

namespace kiva_ros {

/// roscpp only queues what its publishers publish; a thread of its own writes it.
class PollThread {
 public:
  PollThread();
  ~PollThread();
  /// Returns when that thread has handed all that was published before to the sockets.
  void flush();

 private:
  std::mutex mutex_;
  std::condition_variable turned_;
  std::uint64_t turns_ = 0;  ///< Of that thread; guarded by mutex_.
  boost::signals2::connection connection_;
};

}  // namespace kiva_ros
