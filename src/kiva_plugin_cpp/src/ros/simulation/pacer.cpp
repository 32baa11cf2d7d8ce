// SPDX-License-Identifier: Apache-2.0
#include "pacer.h"

#include <algorithm>
#include <cmath>

namespace kiva_ros {
namespace {

constexpr double kBatch = 0.002;      // [s]
constexpr double kMostArrears = 0.1;  // [s]
constexpr int kUnpacedSteps = 1000;
constexpr double kMostSteps = 1e6;  // in a batch, for any factor

WallClock::duration seconds(double s) {
  return std::chrono::duration_cast<WallClock::duration>(std::chrono::duration<double>(s));
}

}  // namespace

Pacer::Pacer(double step_size, double rtf) : rtf_(rtf) {
  if (!paced()) return;
  wall_per_step_ = step_size / rtf;
  batch_ = std::max(1, static_cast<int>(kBatch / wall_per_step_));
}

void Pacer::restart(WallClock::time_point now) {
  origin_ = now;
  done_ = 0;
}

int Pacer::due(WallClock::time_point now) {
  if (!paced()) return kUnpacedSteps;
  double owed = wallOwed(now);
  const double most = std::max(kMostArrears, wall_per_step_);
  if (owed > most) {
    origin_ += seconds(owed - most);
    owed = most;
  }
  // Tolerates a nanosecond of rounding, which must not move a step to the next batch.
  return static_cast<int>(std::min(std::floor(owed / wall_per_step_ + 1e-3), kMostSteps));
}

WallClock::time_point Pacer::next() const {
  if (!paced()) return WallClock::time_point::min();
  return origin_ + seconds(static_cast<double>(done_ + batch_) * wall_per_step_);
}

double Pacer::wallOwed(WallClock::time_point now) const {
  const double passed = std::chrono::duration<double>(now - origin_).count();
  return passed - static_cast<double>(done_) * wall_per_step_;
}

}  // namespace kiva_ros
