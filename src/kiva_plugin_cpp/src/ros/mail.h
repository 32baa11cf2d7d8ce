// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <utility>
#include <vector>

namespace kiva_ros {

/// What plugins publish: posted on the step thread, done by the broadcaster in its turn, after the
/// clock of the same step.
class Mail {
 public:
  using Letter = std::function<void()>;

  void post(Letter letter) { letters_.push_back(std::move(letter)); }
  std::vector<Letter> take() { return std::exchange(letters_, {}); }

 private:
  std::vector<Letter> letters_;
};

}  // namespace kiva_ros
