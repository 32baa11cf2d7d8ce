// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <utility>
#include <vector>

namespace kiva_ros {

/// Queues the messages of plugins from the step thread to the broadcaster, which publishes them
/// after the clock of the same step.
class PublishQueue {
 public:
  using Publication = std::function<void()>;

  void post(Publication publication) { publications_.push_back(std::move(publication)); }
  std::vector<Publication> take() { return std::exchange(publications_, {}); }

 private:
  std::vector<Publication> publications_;
};

}  // namespace kiva_ros
