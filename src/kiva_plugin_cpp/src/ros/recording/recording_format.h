// SPDX-License-Identifier: Apache-2.0
//
// What a recording holds, as an ordinary bag:
//
//   /mov /movx /movy /rot /lift  the commands; what came on /warehouse/follow for many robots
//   /follow /cancel /stop        is written as one /follow for each
//   /follow_limited              a path with speed limits
//   /warehouse/state_hash        of every simulated second, of every second, and of the end
//   whatever a plugin hears      /cmd_vel for instance, as it took effect
//   /warehouse/shadows           where robots are that are elsewhere, as it took effect
//   /tf                          where the robots are, twice a second: for RViz
//   /warehouse/keyframe          std_msgs/UInt8MultiArray: a checkpoint, at the beginning and
//                                whenever models came, went or were moved from outside
//
// Messages are stamped by simulated time since the beginning, counted in steps, so that no reset
// and no restore makes it go back; the nanoseconds beyond a step keep the order within it.
#pragma once

#include <ros/time.h>

#include <cmath>
#include <cstdint>

namespace kiva_ros {

constexpr char kHashTopic[] = "/warehouse/state_hash";
constexpr char kKeyframeTopic[] = "/warehouse/keyframe";

/// Returns the time stamp of message number `index` within a step.
inline ros::Time recordingStamp(std::uint64_t step, double step_size, std::uint32_t index) {
  ros::Time stamp;
  stamp.fromNSec(
      static_cast<std::uint64_t>(std::llround(static_cast<double>(step) * step_size * 1e9)) +
      index + 1);  // a bag knows no time 0
  return stamp;
}

inline std::uint64_t stepOf(const ros::Time& stamp, double step_size) {
  return static_cast<std::uint64_t>(
      std::floor((static_cast<double>(stamp.toNSec()) - 0.5) / (step_size * 1e9) + 1e-9));
}

}  // namespace kiva_ros
