// SPDX-License-Identifier: Apache-2.0
//
// The paths that a step keeps of the last one. Every robot begins with the rest of its path, so
// that there is a plan without conflicts before any search.
#pragma once

#include <cstdint>
#include <vector>

#include "core/parallel/threads.h"
#include "core/search/candidates.h"
#include "core/search/reservations.h"

namespace fleet {

class Inheritance {
 public:
  /// Keeps all references, which must outlive the object.
  Inheritance(const std::vector<Wish>& wishes, const Candidates& candidates, Reservations& reserved,
              const Threads& threads)
      : wishes_(wishes), candidates_(candidates), reserved_(reserved), threads_(threads) {}

  /// Gives each robot the rest of its path, if it can still be driven. If a robot is elsewhere than
  /// planned, all stand, and resume their paths where they block no other.
  void begin(const Fleet& fleet);
  /// Remembers where the paths of this step begin.
  void remember();

 private:
  struct Begin {
    GridPose state;
    Deck deck = Deck::kUnder;
  };

  void findRest(int robot);
  void resume();

  const std::vector<Wish>& wishes_;
  const Candidates& candidates_;
  Reservations& reserved_;
  const Threads& threads_;
  std::vector<Begin> begins_;  ///< by robot; kNowhere without a path
  // By robot, in this step:
  std::vector<Path> rests_;
  std::vector<std::uint8_t> is_as_planned_;
};

}  // namespace fleet
