// SPDX-License-Identifier: Apache-2.0
//
// Assigns each robot the table to its goal, and limits the work on tables of a step.
#pragma once

#include <cstdint>
#include <vector>

#include "core/floor/distance_tables.h"
#include "core/search/candidates.h"
#include "core/search/making_way.h"

namespace fleet {

struct MeasuringOptions {
  int table_work = 0;    ///< largest number of states a robot in new tables of one step
  int renewal_work = 0;  ///< largest number of states a robot in renewed tables of one step
  int renewal_age = 0;   ///< age at which a table is renewed, if there is work left [ticks]
};

class Measuring {
 public:
  /// Keeps all references, which must outlive the object.
  Measuring(const Floor& floor, const MeasuringOptions& options, DistanceTables& tables)
      : floor_(floor), options_(options), tables_(tables) {}

  /// Sets the tables of all wishes, at time `now`, with edges of that version. Removes goals that
  /// can't be reached. Robots that stand (`way`) get renewed tables first. `seconds`: the time of
  /// the whole step; 0: no more than the options' work is done.
  void measure(int now, int version, double seconds, const MakingWay& way,
               std::vector<Wish>& wishes);

 private:
  std::int64_t work(std::int64_t a_robot, std::size_t robots) const;
  void need(const std::vector<Wish>& wishes);
  void find(bool waits, Wish& wish);
  void renew(double seconds, std::size_t robots);

  const Floor& floor_;
  const MeasuringOptions options_;
  DistanceTables& tables_;
};

}  // namespace fleet
