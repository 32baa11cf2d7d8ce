// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <memory>
#include <vector>

namespace kiva {

class Workers;

/// How a step's work on the robots is shared out.
struct StepSchedule {
  std::vector<int> stepped_singly;   ///< Robots that are awake and do not cruise.
  std::vector<char> cruised;         ///< Scratch: what is to be done for each block of robots.
  std::shared_ptr<Workers> workers;  ///< The threads.
};

}  // namespace kiva
