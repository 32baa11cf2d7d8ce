// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

namespace kiva {

class Workers;

/// The distribution of a step's work on the robots.
struct StepSchedule {
  std::vector<int> stepped_singly;   ///< Robots that are awake and do not cruise.
  std::vector<char> cruised;         ///< Scratch: the work left for each block of robots.
  std::shared_ptr<Workers> workers;  ///< The threads.
};

}  // namespace kiva
