// SPDX-License-Identifier: Apache-2.0
#include "poll_thread.h"

#include <ros/poll_manager.h>

#include <chrono>

namespace kiva_ros {
namespace {

constexpr auto kPatience = std::chrono::seconds(1);  // the thread may have ended already

}  // namespace

PollThread::PollThread()
    : connection_(ros::PollManager::instance()->addPollThreadListener([this] {
        {
          const std::lock_guard<std::mutex> lock(mutex_);
          ++turns_;
        }
        turned_.notify_all();
      })) {}

PollThread::~PollThread() { ros::PollManager::instance()->removePollThreadListener(connection_); }

void PollThread::flush() {
  std::unique_lock<std::mutex> lock(mutex_);
  // The turn in progress may have passed the queues already; the next one empties them.
  const std::uint64_t enough = turns_ + 2;
  const auto end = std::chrono::steady_clock::now() + kPatience;
  while (turns_ < enough && std::chrono::steady_clock::now() < end) {
    const std::uint64_t now = turns_;
    lock.unlock();
    ros::PollManager::instance()->getPollSet().signal();
    lock.lock();
    turned_.wait_until(lock, end, [&] { return turns_ > now; });
  }
}

}  // namespace kiva_ros
