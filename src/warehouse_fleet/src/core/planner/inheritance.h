// SPDX-License-Identifier: Apache-2.0
//
// What a step keeps of the last: every robot begins with what is left of its path, so there is a
// plan without conflicts before anything is searched.
#pragma once

#include <cstdint>
#include <vector>

#include "core/parallel/threads.h"
#include "core/search/candidates.h"
#include "core/search/reservations.h"

namespace fleet {

class Inheritance {
 public:
  /// All references must outlive it.
  Inheritance(const std::vector<Wish>& wishes, const Candidates& candidates, Reservations& reserved,
              const Threads& threads)
      : wishes_(wishes), candidates_(candidates), reserved_(reserved), threads_(threads) {}

  /// Gives each robot the rest of its path, if it still can be driven. If a robot is not where its
  /// plan has it, all stand, and take up their paths again where they block no other.
  void begin(const Fleet& fleet);
  /// Remembers where the paths of this step begin.
  void remember();

 private:
  struct Begin {
    State state;
    Deck deck = Deck::kUnder;
  };

  void findRest(int robot);
  void resume();

  const std::vector<Wish>& wishes_;
  const Candidates& candidates_;
  Reservations& reserved_;
  const Threads& threads_;
  std::vector<Begin> begins_;  ///< by robot; kNowhere: it has no path
  // Of a step, by robot:
  std::vector<Path> rests_;
  std::vector<std::uint8_t> is_as_planned_;
};

}  // namespace fleet
