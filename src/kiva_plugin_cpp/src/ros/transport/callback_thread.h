// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/callback_queue.h>
#include <ros/ros.h>

namespace kiva_ros {

/// A callback queue with a thread of its own, for services whose calls may take long: one call at a
/// time, while all others are answered by other threads. Outlives what is advertised by its node.
class CallbackThread {
 public:
  explicit CallbackThread(const ros::NodeHandle& node) : node_(node), spinner_(1, &queue_) {
    node_.setCallbackQueue(&queue_);
  }

  /// The same names, served by this thread.
  ros::NodeHandle& node() { return node_; }
  void start() { spinner_.start(); }
  /// Waits for the call that is being answered.
  void stop() { spinner_.stop(); }

 private:
  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::AsyncSpinner spinner_;
};

}  // namespace kiva_ros
