// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <map>
#include <string>
#include <vector>

#include "ros/transport/wall_clock.h"

namespace kiva_ros {

/// How far simulated time may pass before the nodes that keep pace with it have spoken again, such
/// as a coordinator whose robots would wait for it otherwise.
class PaceLimit {
 public:
  /// Lets time pass until `until` [s] as far as that node is concerned.
  void allow(const std::string& node, double until, WallClock::time_point now);
  /// Waits for that node no longer, until it speaks again.
  void release(const std::string& node) { grants_.erase(node); }
  void releaseAll() { grants_.clear(); }
  /// Returns whether some node keeps time from passing `time` [s].
  bool holds(double time) const;
  /// Releases the nodes that keep time from passing `time` [s] and have said nothing while it has
  /// stood there for ten seconds, since `stands_since`. Returns their names.
  std::vector<std::string> releaseSilent(double time, WallClock::time_point stands_since,
                                         WallClock::time_point now);

 private:
  struct Grant {
    double until = 0;  ///< Simulated [s].
    WallClock::time_point given_at;

    bool holds(double time) const;
  };

  std::map<std::string, Grant> grants_;  ///< By the node's name.
};

}  // namespace kiva_ros
