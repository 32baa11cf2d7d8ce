// SPDX-License-Identifier: Apache-2.0
#include "core/search/priorities.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <tuple>

namespace fleet {
namespace {

/// Ranks robots that go to the same cell by distance, the nearest first. A robot that has waited
/// longer behind the nearest would otherwise push it past their goal. Directed robots have another
/// order.
void nearestFirst(const std::vector<Wish>& wishes, const MakingWay& way,
                  const std::vector<int>& distance, std::vector<int>& key) {
  std::vector<int> by_distance;
  for (int robot = 0; robot < static_cast<int>(key.size()); ++robot) {
    const bool is_first = way.isDirected(robot) || wishes[robot].is_urgent;
    if (!is_first && !wishes[robot].yields) by_distance.push_back(robot);
  }
  std::vector<int> by_key = by_distance;
  const auto sort = [&](std::vector<int>& robots, const std::vector<int>& value) {
    std::sort(robots.begin(), robots.end(), [&](int robot, int other) {
      return std::tie(wishes[robot].goal, value[robot], robot) <
             std::tie(wishes[other].goal, value[other], other);
    });
  };
  sort(by_distance, distance);
  sort(by_key, key);
  const std::vector<int> keys = key;
  for (std::size_t i = 0; i < by_key.size(); ++i) key[by_distance[i]] = keys[by_key[i]];
}

/// Returns a key for each robot; the smallest goes first. The robot nearest to its goal goes first,
/// which serves throughput. Waiting reduces the key, so that no robot waits for ever. Standing in
/// one cell reduces it faster: beside a stream of robots that have waited elsewhere, the robot
/// would never be let in.
std::vector<int> keys(const std::vector<Wish>& wishes, const std::vector<int>& waiting,
                      const Candidates& candidates, const MakingWay& way) {
  constexpr int kWaitingWorth = 2;  // weight of a tick of waiting [kTickCost]
  constexpr int kStandingWorth =
      24;                     // weight of a tick of standing, after the first kStands [kTickCost]
  constexpr int kStands = 8;  // ticks in a cell
  constexpr int kFirst = std::numeric_limits<int>::min();
  constexpr int kLast = std::numeric_limits<int>::max();
  const int robots = static_cast<int>(wishes.size());
  std::vector<int> distance(robots), key(robots);
  for (int robot = 0; robot < robots; ++robot) {
    const Wish& wish = wishes[robot];
    const bool has_goal = wish.goal != kNowhere && !wish.yields;
    distance[robot] = has_goal ? candidates.distance(wish, wish.state) : kLast;
    const int waited = kWaitingWorth * waiting[robot];
    const int stood = kStandingWorth * std::max(0, way.still(robot) - kStands);
    key[robot] = distance[robot] - (has_goal ? waited + stood : 0);
    if (way.isDirected(robot) || wish.is_urgent) key[robot] = kFirst;
  }
  nearestFirst(wishes, way, distance, key);
  return key;
}

}  // namespace

void Priorities::assign(const std::vector<Wish>& wishes, const std::vector<int>& waiting,
                        const Candidates& candidates, const MakingWay& way) {
  const std::vector<int> key = keys(wishes, waiting, candidates, way);
  const int robots = static_cast<int>(key.size());
  order_.resize(robots);
  std::iota(order_.begin(), order_.end(), 0);
  std::sort(order_.begin(), order_.end(), [&](int robot, int other) {
    return key[robot] != key[other] ? key[robot] < key[other] : robot < other;
  });
  rank_.resize(robots);
  weight_.resize(robots);
  for (int rank = 0; rank < robots; ++rank) {
    const double share = 1 - static_cast<double>(rank) / robots;
    rank_[order_[rank]] = rank;
    weight_[order_[rank]] = 1 + static_cast<int>(1000 * share * share);
  }
}

}  // namespace fleet
