// SPDX-License-Identifier: Apache-2.0
//
// Observations of robots, as warehouse_learning/fields.py describes them, without motion and
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
  /// `radius`: that of the neighbourhood [cells], at most the floor's rim.
  Observer(const RimmedFloor& floor, const TaskState& state, const Goals& goals, int radius);

  /// Returns the count of numbers a robot.
  int size() const;
  /// Writes a row a robot, `stride` numbers apart, warehouse by warehouse.
  void observe(float* out, int stride);

 private:
  static constexpr int kLayers = 7;
  using Layers = std::array<float, kLayers>;

  void lookAt(int w);
  float* own(float* row, int w, int robot) const;
  float* goal(float* row, int w, int robot) const;
  void around(float* row, int cell, int heading) const;

  const RimmedFloor& floor_;
  const TaskState& state_;
  const Goals& goals_;
  std::vector<std::uint8_t> still_;  // bits of each cell's immobile properties
  std::vector<std::uint8_t> look_;   // the same with mobile properties, of one warehouse at a time
  std::array<std::vector<int>, 4>
      around_;  // by heading: differences of the cells around and the robot's
  std::array<Layers, 1 << kLayers> layers_{};  // numbers for each combination of a cell's bits
};

}  // namespace learning
