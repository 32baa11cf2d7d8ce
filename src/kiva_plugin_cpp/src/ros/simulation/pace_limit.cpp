// SPDX-License-Identifier: Apache-2.0
#include "pace_limit.h"

#include <algorithm>
#include <iterator>

namespace kiva_ros {
namespace {

constexpr double kRounding = 1e-6;  // [s], less than a step

}  // namespace

bool PaceLimit::Grant::holds(double time) const { return until <= time + kRounding; }

void PaceLimit::allow(const std::string& node, double until, WallClock::time_point now) {
  grants_[node] = {until, now, kMostSilence};
}

void PaceLimit::await(const std::string& node, double until, WallClock::time_point now) {
  grants_[node] = {until, now, kMostStart};
}

bool PaceLimit::holds(double time) const {
  return std::any_of(grants_.begin(), grants_.end(),
                     [time](const auto& entry) { return entry.second.holds(time); });
}

std::vector<PaceLimit::Silent> PaceLimit::releaseSilent(double time,
                                                        WallClock::time_point stands_since,
                                                        WallClock::time_point now) {
  const bool is_starting = std::any_of(grants_.begin(), grants_.end(), [time](const auto& entry) {
    return !entry.second.hasStarted() && entry.second.holds(time);
  });
  if (is_starting) last_start_ = now;
  std::vector<Silent> out;
  for (auto it = grants_.begin(); it != grants_.end();) {
    const Grant& grant = it->second;
    auto silent_since = std::max(grant.given_at, stands_since);
    if (grant.hasStarted()) silent_since = std::max(silent_since, last_start_);
    const bool is_silent = grant.holds(time) && now >= silent_since + grant.patience;
    if (is_silent) out.push_back({it->first, grant.patience});
    it = is_silent ? grants_.erase(it) : std::next(it);
  }
  return out;
}

}  // namespace kiva_ros
