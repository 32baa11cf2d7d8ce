// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>

#include <string>

namespace kiva_ros {

/// The client of a service call.
class ServiceCaller {
 public:
  /// `service`: its full name. `header`: the call's connection header, from
  /// ServiceEvent::getConnectionHeader().
  ServiceCaller(const std::string& service, const ros::M_string& header);
  /// Returns whether the client has closed its connection, so that the answer is void.
  bool isGone() const;

 private:
  boost::shared_ptr<ros::Connection> connection_;
};

}  // namespace kiva_ros
