// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/publication.h>
#include <ros/serialized_message.h>

#include <vector>

namespace kiva_ros {

/// Writes messages of one topic, in order, to all of its subscribers: immediately and together, in
/// the caller's thread. If older messages are queued, or the socket is full, roscpp's thread sends
/// them, and drops the oldest beyond the topic's queue size. One thread a topic.
void writeToSubscribers(ros::Publication& topic,
                        const std::vector<ros::SerializedMessage>& messages);

}  // namespace kiva_ros
