// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <malloc.h>
#include <ros/ros.h>

#include <cstddef>

namespace kiva_ros {

/// Returns free memory to the system after much was freed. The heap itself gives back only what is
/// free at its end: a warehouse's events, in queues of subscribers that read slowly, leave gaps
/// below what stays, a third of the node's memory. Takes some milliseconds, in which other threads
/// wait for memory. One thread at a time: the one that serves `node`.
class HeapTrim {
 public:
  explicit HeapTrim(const ros::NodeHandle& node)
      : timer_(node.createWallTimer(
            ros::WallDuration(kLook), [this](const ros::WallTimerEvent&) { look(); }, false,
            false)) {}
  /// Trims the heap once what is in use stays the same, as it does with queues that are empty.
  void whenSteady() {
    used_ = 0;
    timer_.start();
  }

 private:
  static constexpr double kLook = 2;           // [s, wall] from one look to the next
  static constexpr std::size_t kSteady = 100;  // memory is steady if it changes by at most 1/100

  void look() {
    const std::size_t before = used_;
    used_ = mallinfo2().uordblks;
    const std::size_t change = used_ > before ? used_ - before : before - used_;
    if (change > used_ / kSteady) return;
    timer_.stop();
    malloc_trim(0);
  }

  std::size_t used_ = 0;  ///< At the last look [bytes].
  ros::WallTimer timer_;
};

}  // namespace kiva_ros
