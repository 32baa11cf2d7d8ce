// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/ros.h>

#include <string>

namespace kiva_ros {

/// Who waits for the answer of a service call.
class ServiceCaller {
 public:
  /// `service`: its full name. `header`: the call's own, that ServiceEvent::getConnectionHeader()
  /// returns.
  ServiceCaller(const std::string& service, const ros::M_string& header);
  /// Whether its connection was closed: nobody will read the answer.
  bool isGone() const;

 private:
  boost::shared_ptr<ros::Connection> connection_;
};

}  // namespace kiva_ros
