// SPDX-License-Identifier: Apache-2.0
#include "observer.h"

#include <algorithm>

namespace learning {
namespace {

/// The properties of a cell, in the order of fields.LAYERS.
enum Layer : std::uint8_t {
  kBlocked = 1,
  kStorage = 2,
  kStation = 4,
  kUnit = 8,
  kRequested = 16,
  kRobot = 32,
  kLoaded = 64
};

constexpr int kOwn = 10, kGoal = 7;  // numbers before the neighbourhood

float share(int at, int cells) {
  return static_cast<float>(std::clamp(double(at) / std::max(cells - 1, 1), 0.0, 1.0));
}

float* oneHot(float* out, int which, int of) {
  for (int k = 0; k < of; ++k) *out++ = k == which ? 1 : 0;
  return out;
}

}  // namespace

Observer::Observer(const RimmedFloor& floor, const TaskState& state, const Goals& goals, int radius)
    : floor_(floor), state_(state), goals_(goals), still_(floor.size()) {
  for (int cell = 0; cell < floor.size(); ++cell) {
    still_[cell] = (floor.isPassable(cell) ? 0 : kBlocked) |
                   (floor.isStorage(cell) ? kStorage : 0) | (floor.isStation(cell) ? kStation : 0);
  }
  for (std::size_t bits = 0; bits < layers_.size(); ++bits) {
    for (int layer = 0; layer < kLayers; ++layer) {
      layers_[bits][layer] = static_cast<float>((bits >> layer) & 1);
    }
  }
  for (int heading = 0; heading < 4; ++heading) {
    for (int ahead = -radius; ahead <= radius; ++ahead) {
      for (int left = -radius; left <= radius; ++left) {
        around_[heading].push_back(ahead * floor.step(heading) + left * floor.step(heading + 1));
      }
    }
  }
}

int Observer::size() const { return kOwn + kGoal + kLayers * static_cast<int>(around_[0].size()); }

void Observer::observe(float* out, int stride) {
  for (int w = 0; w < state_.warehouses(); ++w) {
    lookAt(w);
    for (int robot = 0; robot < state_.robots(); ++robot, out += stride) {
      float* const rest = goal(own(out, w, robot), w, robot);
      around(rest, state_.cell[w][robot], state_.heading[w][robot]);
    }
  }
}

void Observer::lookAt(int w) {
  look_ = still_;
  for (int unit = 0; unit < state_.units(); ++unit) {
    const int cell = state_.unit_cell[w][unit];
    if (cell != kNone) look_[cell] |= state_.requested[w][unit] ? kUnit | kRequested : kUnit;
  }
  for (int robot = 0; robot < state_.robots(); ++robot) {
    look_[state_.cell[w][robot]] |= state_.load[w][robot] == kNone ? kRobot : kRobot | kLoaded;
  }
}

/// Writes position 2, heading 4, load 3, busy 1.
float* Observer::own(float* row, int w, int robot) const {
  const int cell = state_.cell[w][robot], load = state_.load[w][robot];
  const int rim = floor_.rim();
  *row++ = share(floor_.x(cell) - rim, floor_.width() - 2 * rim);
  *row++ = share(floor_.y(cell) - rim, floor_.height() - 2 * rim);
  row = oneHot(row, state_.heading[w][robot], 4);
  row = oneHot(row, load == kNone ? 0 : state_.requested[w][load] ? 1 : 2, 3);
  *row++ = state_.busy[w][robot] ? 1 : 0;
  return row;
}

/// Writes goal 2, distance 1, way 4.
float* Observer::goal(float* row, int w, int robot) const {
  constexpr int kCos[] = {1, 0, -1, 0}, kSin[] = {0, 1, 0, -1};
  const int cell = state_.cell[w][robot], heading = state_.heading[w][robot];
  const int goal = goals_.cell(w, robot);
  const double edge = floor_.longest();
  const double dx = (floor_.x(goal) - floor_.x(cell)) / edge;
  const double dy = (floor_.y(goal) - floor_.y(cell)) / edge;
  const int c = kCos[heading], s = kSin[heading];
  *row++ = static_cast<float>(std::clamp(c * dx + s * dy, -1.0, 1.0));
  *row++ = static_cast<float>(std::clamp(c * dy - s * dx, -1.0, 1.0));
  const int here = goals_.distance(w, robot);
  *row++ = static_cast<float>(std::min(here / (2 * edge), 1.0));
  const Way* const way = goals_.way(w, robot);
  for (int k = 0; k < 4; ++k) {
    const int next = way ? (*way)[floor_.inside(cell + floor_.step(heading + k))] : here;
    *row++ = next == kFar ? -1 : static_cast<float>(std::clamp(here - next, -1, 1));
  }
  return row;
}

/// Writes cells from behind right to ahead left, as the robot faces them.
void Observer::around(float* row, int cell, int heading) const {
  for (const int offset : around_[heading]) {
    row = std::copy_n(layers_[look_[floor_.inside(cell + offset)]].data(), kLayers, row);
  }
}

}  // namespace learning
