// SPDX-License-Identifier: Apache-2.0
#include "core/parallel/step_trial.h"

#include <algorithm>

namespace kiva {
namespace {

// Speed-up from which threads are worth it: waiting threads use their cores as if they worked.
constexpr double kWorth = 1.35;

double median(std::vector<double>& values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

void StepTrial::endStep() {
  if (tries_) {
    times_[shares_].push_back(std::chrono::duration<double>(Clock::now() - begin_).count());
    if (left_ % kTurn == 0) shares_ = !shares_;
  }
  if (--left_ > 0) return;
  if (tries_) decide();
  tries_ = !tries_;
  left_ = tries_ ? kSteps : kBetween;
}

void StepTrial::decide() {
  shares_ = median(times_[false]) > kWorth * median(times_[true]);
  for (auto& times : times_) times.clear();
}

}  // namespace kiva
