// SPDX-License-Identifier: Apache-2.0
#include "yielding.h"

#include <algorithm>
#include <cstdlib>

namespace fleet {
namespace {
double env(const char* name, double otherwise) {
  const char* text = getenv(name);
  return text ? atof(text) : otherwise;
}
}

Yielding::Yielding(const Floor& floor, double share) {
  int passable = 0;
  for (Cell cell = 0; cell < floor.size(); ++cell) passable += floor.isPassable(cell);
  most_ = static_cast<int>(env("SHARE", share) * passable);
}

void Yielding::choose(const std::vector<int>& waiting, const Candidates& candidates,
                      std::vector<Wish>& wishes) {
  const int robots = static_cast<int>(wishes.size());
  pursued_.resize(robots, kNowhere);
  static const double worth = env("WORTH", 0);
  std::vector<std::pair<int, int>> open;
  int pursuing = 0;
  for (int robot = 0; robot < robots; ++robot) {
    Wish& wish = wishes[robot];
    if (pursued_[robot] != wish.goal) pursued_[robot] = kNowhere;
    wish.yields = pursued_[robot] == kNowhere;
    if (!wish.yields) {
      ++pursuing;
    } else if (wish.goal != kNowhere) {
      open.emplace_back(candidates.distance(wish, wish.state) - int(worth * waiting[robot]), robot);
    }
  }
  const std::size_t room = std::min<std::size_t>(open.size(), std::max(0, most_ - pursuing));
  std::partial_sort(open.begin(), open.begin() + room, open.end());
  for (std::size_t i = 0; i < room; ++i) {
    Wish& wish = wishes[open[i].second];
    wish.yields = false;
    pursued_[open[i].second] = wish.goal;
  }
}

}  // namespace fleet
