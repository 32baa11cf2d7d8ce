// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <malloc.h>
#include <ros/ros.h>

#include "ros/transport/steady_use.h"

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
    use_.restart();
    timer_.start();
  }

 private:
  static constexpr double kLook = 2;  // [s, wall] from one look to the next

  void look() {
    if (!use_.isSteadyAt(mallinfo2().uordblks)) return;
    timer_.stop();
    malloc_trim(0);
  }

  SteadyUse use_;
  ros::WallTimer timer_;
};

}  // namespace kiva_ros
