// SPDX-License-Identifier: Apache-2.0
#include "core/floor/guidance.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace fleet {

namespace {

/// Largest distance of a street beside a lane from that lane [cells].
constexpr int kAtLanes = 3;
/// Share of learnt costs that counts in streets with a direction: who meets others there can't
/// avoid them, and a detour leads around a block.
constexpr double kLearntInStreets = 0.3;

std::vector<std::uint8_t> cellsAtLanes(const Floor& floor) {
  std::vector<std::uint8_t> is_near(floor.size());
  for (Cell cell = 0; cell < floor.size(); ++cell) {
    if (!floor.isLane(cell)) continue;
    for (int dy = -kAtLanes; dy <= kAtLanes; ++dy) {
      for (int dx = std::abs(dy) - kAtLanes; dx <= kAtLanes - std::abs(dy); ++dx) {
        const int x = floor.x(cell) + dx, y = floor.y(cell) + dy;
        if (x < 0 || y < 0 || x >= floor.width() || y >= floor.height()) continue;
        const Cell near = y * floor.width() + x;
        is_near[near] = !floor.isLane(near);
      }
    }
  }
  return is_near;
}

std::uint8_t costOf(double ticks) {
  return static_cast<std::uint8_t>(std::min<long>(kMaxEdgeCost, std::lround(ticks * kTickCost)));
}

}  // namespace

Guidance::Guidance(const Floor& floor, const GuidanceOptions& options)
    : floor_(floor),
      options_(options),
      drove_(floor.size() * kHeadings),
      waited_(floor.size()),
      is_at_lanes_(cellsAtLanes(floor)),
      costs_(floor.size() * kHeadings, kTickCost) {
  if (options.streets == 0) return;
  street_ways_ = streetWays(floor);
  for (std::size_t edge = 0; edge < costs_.size(); ++edge) {
    costs_[edge] = costOf(1 + againstStreet(edge));
  }
}

void Guidance::tick() {
  resting_.clear();
  constexpr double kLargestGain = 1e6;
  gain_ *= std::exp(1 / options_.memory);
  if (gain_ < kLargestGain) return;
  for (float& sum : drove_) sum /= gain_;
  for (float& sum : waited_) sum /= gain_;
  gain_ = 1;
}

void Guidance::refresh(double against) {
  // A sum with exponential forgetting converges to memory * mean.
  const double per_tick = 1 / (gain_ * options_.memory);
  std::vector<std::uint8_t> rests(floor_.size());
  for (const Cell cell : resting_) rests[cell] = 1;
  for (Cell cell = 0; cell < floor_.size(); ++cell) {
    for (int heading = 0; heading < kHeadings; ++heading) {
      const Cell to = floor_.next(Deck::kUnder, cell, heading);
      if (to == kNowhere) continue;
      const std::size_t edge = cell * kHeadings + heading;
      const double met = drove_[to * kHeadings + turned(heading, 2)] * per_tick;
      const double learnt = streetWay(edge) == StreetWay::kNone ? 1 : kLearntInStreets;
      const double ticks =
          1 + learnt * against * met + learnt * options_.crowd * waited_[to] * per_tick +
          options_.at_lanes * is_at_lanes_[to] + options_.resting * rests[to] + againstStreet(edge);
      costs_[edge] = costOf(ticks);
    }
  }
}

}  // namespace fleet
