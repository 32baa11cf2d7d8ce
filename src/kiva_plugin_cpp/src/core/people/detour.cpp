// SPDX-License-Identifier: Apache-2.0
#include "core/people/detour.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <unordered_map>

#include "core/people/footing.h"

namespace kiva {
namespace {

constexpr double kPace = 0.25;                 // [m] between two neighbouring places
constexpr int kMostPlaces = 20000;             // limit of places that a search visits
constexpr int kDiagonal = 99, kStraight = 70;  // integer costs, without rounding errors
constexpr int kFarthest = 1000;                // paces from the person

struct PacePlace {
  int i = 0, j = 0;  // position relative to the person [paces]
  bool operator==(const PacePlace& o) const { return i == o.i && j == o.j; }
};

int keyOf(const PacePlace& p) { return (p.i + kFarthest) * (2 * kFarthest + 1) + p.j + kFarthest; }

/// Returns a lower bound of the cost from one place to another.
int estimate(const PacePlace& a, const PacePlace& b) {
  const int di = std::abs(a.i - b.i), dj = std::abs(a.j - b.j);
  return kStraight * std::max(di, dj) + (kDiagonal - kStraight) * std::min(di, dj);
}

/// Searches a detour by A* over places a pace apart (Hart, Nilsson, Raphael 1968).
class DetourSearch {
 public:
  DetourSearch(const Scene& world, const Walker& walker, double x, double y)
      : world_(world), walker_(walker), from_(world.models[walker.model]->pose) {
    goal_ = {static_cast<int>(std::lround((x - from_.X()) / kPace)),
             static_cast<int>(std::lround((y - from_.Y()) / kPace))};
  }

  /// Returns the places from the goal back to the person, without the last one; empty if there is
  /// no way.
  std::vector<PacePlace> run() {
    if (std::max(std::abs(goal_.i), std::abs(goal_.j)) >= kFarthest) return {};
    reach({0, 0}, {0, 0}, 0);
    while (!open_.empty() && static_cast<int>(known_.size()) < kMostPlaces) {
      const PacePlace at = open_.top().place;
      open_.pop();
      if (at == goal_) return wayTo(at);
      Known& here = known_.at(keyOf(at));
      if (!here.is_done) {
        here.is_done = true;
        expand(at, here.cost);
      }
    }
    return {};
  }

  PathPoint pointOf(const PacePlace& p) const {
    return {from_.X() + kPace * p.i, from_.Y() + kPace * p.j};
  }

 private:
  struct Known {
    PacePlace from;
    int cost = 0;
    bool is_done = false;
  };
  struct Open {
    int estimate;
    PacePlace place;
    bool operator<(const Open& o) const {  // the cheapest is the greatest; ties have a fixed order
      return estimate != o.estimate ? estimate > o.estimate : keyOf(place) > keyOf(o.place);
    }
  };

  void expand(const PacePlace& at, int cost) {
    for (int di = -1; di <= 1; ++di) {
      for (int dj = -1; dj <= 1; ++dj) {
        const PacePlace next{at.i + di, at.j + dj};
        if (next == at || std::max(std::abs(next.i), std::abs(next.j)) >= kFarthest) continue;
        reach(next, at, cost + (di != 0 && dj != 0 ? kDiagonal : kStraight));
      }
    }
  }

  void reach(const PacePlace& place, const PacePlace& from, int cost) {
    const auto at = known_.find(keyOf(place));
    if (at != known_.end() && (at->second.is_done || at->second.cost <= cost)) return;
    if (at == known_.end() && !(place == PacePlace()) && !hasRoom(place)) return;
    known_[keyOf(place)] = {from, cost, false};
    open_.push({cost + estimate(place, goal_), place});
  }

  bool hasRoom(const PacePlace& place) {
    const auto [at, is_new] = has_room_.try_emplace(keyOf(place), false);
    if (is_new) {
      const PathPoint p = pointOf(place);
      at->second = clearanceAt(world_, walker_, p.x, p.y) >= 0;
    }
    return at->second;
  }

  std::vector<PacePlace> wayTo(PacePlace at) const {
    std::vector<PacePlace> way;
    for (; !(at == PacePlace()); at = known_.at(keyOf(at)).from) way.push_back(at);
    return way;
  }

  const Scene& world_;
  const Walker& walker_;
  const Pose from_;
  PacePlace goal_;
  // Used for look-ups only, since the order is undefined.
  std::unordered_map<int, Known> known_;
  std::unordered_map<int, bool> has_room_;
  std::priority_queue<Open> open_;
};

bool isStraight(const PacePlace& a, const PacePlace& b, const PacePlace& c) {
  return b.i - a.i == c.i - b.i && b.j - a.j == c.j - b.j;
}

}  // namespace

std::vector<PathPoint> findDetour(const Scene& world, const Walker& walker, double x, double y) {
  DetourSearch search(world, walker, x, y);
  const std::vector<PacePlace> way = search.run();
  std::vector<PathPoint> points;
  for (std::size_t k = 0; k < way.size(); ++k) {
    const PacePlace after = k + 1 < way.size() ? way[k + 1] : PacePlace();
    if (k > 0 && isStraight(way[k - 1], way[k], after)) continue;
    points.push_back(k == 0 ? PathPoint{x, y} : search.pointOf(way[k]));
  }
  return points;
}

}  // namespace kiva
