// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace kiva_ros {

/// Lets a thousand clients, or one with a thousand topics, connect at the same time. roscpp's
/// server queues five connections; further clients try again after 1 s, then 3 s, up to a minute.
/// Call it after ros::start().
void raiseListenBacklog();

}  // namespace kiva_ros
