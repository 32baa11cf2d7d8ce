// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <malloc.h>
#include <ros/ros.h>

namespace kiva_ros {

/// Returns free memory to the system some seconds after much was freed. The heap itself gives back
/// only what is free at its end: a warehouse's events, in queues of subscribers that read slowly,
/// leave gaps below what stays, a third of the node's memory. Takes some milliseconds, in which
/// other threads wait for memory.
class HeapTrim {
 public:
  /// The timer of `node` calls it.
  explicit HeapTrim(const ros::NodeHandle& node)
      : timer_(node.createWallTimer(
            ros::WallDuration(kDelay), [](const ros::WallTimerEvent&) { malloc_trim(0); }, true,
            false)) {}
  /// Trims the heap once queues have become empty; later if called again meanwhile.
  void soon() {
    timer_.stop();
    timer_.start();
  }

 private:
  static constexpr double kDelay = 5;  // [s, wall]; the viewer reads 40,000 events in three

  ros::WallTimer timer_;
};

}  // namespace kiva_ros
