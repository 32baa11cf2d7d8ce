// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/publication.h>
#include <ros/serialized_message.h>

#include <vector>

namespace kiva_ros {

/// Writes messages of one topic, in their order, to all who subscribe to it: at once and together,
/// in the caller's thread. To whom older ones wait, or whose socket is full, roscpp's thread sends
/// them, or forgets the oldest if there are more than the topic's queue holds. One thread a topic.
void writeToSubscribers(ros::Publication& topic,
                        const std::vector<ros::SerializedMessage>& messages);

}  // namespace kiva_ros
