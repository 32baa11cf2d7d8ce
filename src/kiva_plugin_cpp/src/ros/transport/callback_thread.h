// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/callback_queue.h>
#include <ros/ros.h>

namespace kiva_ros {

/// A callback queue with a thread of its own, for services whose calls may take long. It serves one
/// call at a time; other threads answer all others. It must outlive what its node advertises.
class CallbackThread {
 public:
  explicit CallbackThread(const ros::NodeHandle& node) : node_(node), spinner_(1, &queue_) {
    node_.setCallbackQueue(&queue_);
  }

  /// Returns a node with the same names that is served by this thread.
  ros::NodeHandle& node() { return node_; }
  void start() { spinner_.start(); }
  /// Ends the thread after the call in progress.
  void stop() { spinner_.stop(); }

 private:
  ros::CallbackQueue queue_;
  ros::NodeHandle node_;
  ros::AsyncSpinner spinner_;
};

}  // namespace kiva_ros
