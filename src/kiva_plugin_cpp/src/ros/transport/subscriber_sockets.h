// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/publication.h>
#include <ros/serialized_message.h>

#include <vector>

namespace kiva_ros {

/// Writes messages of one topic, in their order, to all of its subscribers: at once and together,
/// in the caller's thread. Where older messages wait, or the socket is full, roscpp's thread sends
/// them, and drops the oldest beyond the topic's queue size. For one thread a topic.
void writeToSubscribers(ros::Publication& topic,
                        const std::vector<ros::SerializedMessage>& messages);

}  // namespace kiva_ros
