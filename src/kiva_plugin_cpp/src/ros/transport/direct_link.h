// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/forwards.h>
#include <ros/serialized_message.h>

namespace kiva_ros {

/// Writes a message to a subscriber's socket at once. What finds no room there, or comes while an
/// earlier one waits, is left to roscpp's queue and thread. In order with what roscpp sends there.
/// Not with a lock that losing the subscriber takes: sending to one that has gone drops it.
void sendDirectly(const ros::SubscriberLinkPtr& link, const ros::SerializedMessage& message);

}  // namespace kiva_ros
