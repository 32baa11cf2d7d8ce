// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <map>
#include <string>
#include <vector>

#include "ros/transport/wall_clock.h"

namespace kiva_ros {

/// How far simulated time may pass before the nodes that keep pace with it have spoken again, such
/// as a coordinator whose robots would wait for it otherwise.
class PaceLimit {
 public:
  /// A node that keeps time waiting for longer, and says nothing, is left behind.
  static constexpr std::chrono::seconds kMostSilence{10};
  /// The same for one that has not spoken yet: on a busy machine a node takes long to start.
  static constexpr std::chrono::seconds kMostStart{60};

  /// Lets time pass until `until` [s] as far as that node is concerned.
  void allow(const std::string& node, double until, WallClock::time_point now);
  /// The same for a node that is still to start.
  void await(const std::string& node, double until, WallClock::time_point now);
  /// Waits for that node no longer, until it speaks again.
  void release(const std::string& node) { grants_.erase(node); }
  void releaseAll() { grants_.clear(); }
  /// Returns whether some node keeps time from passing `time` [s].
  bool holds(double time) const;

  struct Silent {
    std::string node;
    std::chrono::seconds patience;  ///< For how long time has waited for it.
  };
  /// Releases the nodes that keep time from passing `time` [s] and have said nothing for too long
  /// while it has stood there, since `stands_since`. Returns them. As long as time waits for one
  /// that is still to start, those that have started keep nothing waiting.
  std::vector<Silent> releaseSilent(double time, WallClock::time_point stands_since,
                                    WallClock::time_point now);

 private:
  struct Grant {
    double until = 0;  ///< Simulated [s].
    WallClock::time_point given_at;
    std::chrono::seconds patience{};

    bool holds(double time) const;
    bool hasStarted() const { return patience != kMostStart; }
  };

  std::map<std::string, Grant> grants_;  ///< By the node's name.
  WallClock::time_point last_start_;     ///< When time last waited for a node to start.
};

}  // namespace kiva_ros
