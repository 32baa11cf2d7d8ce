// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>

#include "ros/transport/wall_clock.h"

namespace kiva_ros {

/// Reports how far long work is, at most every few seconds; short work is not mentioned.
class Progress {
 public:
  using Now = std::function<WallClock::time_point()>;

  explicit Progress(std::function<void(const std::string&)> say, Now now = WallClock::now)
      : say_(std::move(say)), now_(std::move(now)), next_(now_() + kInterval) {}

  /// `what`: a participle such as "built".
  void at(const std::string& what, std::size_t done, std::size_t all) {
    if (now_() < next_) return;
    next_ = now_() + kInterval;
    say_(what + " " + std::to_string(done) + " of " + std::to_string(all) + " models");
  }

 private:
  static constexpr auto kInterval = std::chrono::seconds(3);

  std::function<void(const std::string&)> say_;
  Now now_;
  WallClock::time_point next_;
};

}  // namespace kiva_ros
