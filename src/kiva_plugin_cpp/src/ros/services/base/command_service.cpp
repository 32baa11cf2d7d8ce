// SPDX-License-Identifier: Apache-2.0
#include "ros/services/base/command_service.h"

#include <warehouse_msgs/Command.h>

namespace kiva_ros {
namespace {

constexpr int kCallQueue = 1000;

}  // namespace

CallTopic::CallTopic(const std::string& service)
    : service_(service),
      topic_(ros::NodeHandle().advertise<warehouse_msgs::Command>("warehouse/service_calls",
                                                                  kCallQueue)) {}

void CallTopic::publish(const std::string& caller, const std::string& fields) const {
  warehouse_msgs::Command call;
  call.topic = service_;
  call.sender = caller;
  call.fields = fields;
  topic_.publish(call);
}

}  // namespace kiva_ros
