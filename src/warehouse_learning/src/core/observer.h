// SPDX-License-Identifier: Apache-2.0
//
// What robots observe, as warehouse_learning/fields.py describes it, but for their motion and their
// lasers.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "floor.h"
#include "goals.h"
#include "state.h"

namespace learning {

class Observer {
 public:
  /// radius: of the neighbourhood [cells], at most the floor's rim.
  Observer(const Floor& floor, const State& state, const Goals& goals, int radius);

  /// How many numbers it fills.
  int size() const;
  /// A row a robot, `stride` numbers apart, warehouse after warehouse.
  void observe(float* out, int stride);

 private:
  static constexpr int kLayers = 7;
  using Layers = std::array<float, kLayers>;

  void lookAt(int w);
  float* own(float* row, int w, int robot) const;
  float* goal(float* row, int w, int robot) const;
  void around(float* row, int cell, int heading) const;

  const Floor& floor_;
  const State& state_;
  const Goals& goals_;
  std::vector<std::uint8_t> still_;            // bits of each cell, of what never moves
  std::vector<std::uint8_t> look_;             // and with what moves, of one warehouse at a time
  std::array<std::vector<int>, 4> around_;     // by heading: what to add to the robot's cell
  std::array<Layers, 1 << kLayers> layers_{};  // the numbers of a cell's bits
};

}  // namespace learning
