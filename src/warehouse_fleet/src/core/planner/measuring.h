// SPDX-License-Identifier: Apache-2.0
//
// Finds each robot the table to its goal, and decides how much of a step goes into tables.
#pragma once

#include <cstdint>
#include <vector>

#include "core/floor/distance_tables.h"
#include "core/search/candidates.h"
#include "core/search/making_way.h"

namespace fleet {

struct MeasuringOptions {
  int table_work = 0;    ///< states a robot that tables made in one step may have
  int renewal_work = 0;  ///< states a robot that tables renewed in one step may have
  int renewal_age = 0;   ///< ticks after which a table is renewed, if there is work left
};

class Measuring {
 public:
  /// All references must outlive it.
  Measuring(const Floor& floor, const MeasuringOptions& options, DistanceTables& tables)
      : floor_(floor), options_(options), tables_(tables) {}

  /// Sets the tables of all wishes, at that time, with edges of that version. A goal that can't be
  /// reached is taken away. Robots that stand (`way`) get renewed tables first.
  void measure(int now, int version, const MakingWay& way, std::vector<Wish>& wishes);

 private:
  std::int64_t work(std::int64_t a_robot, std::size_t robots) const;
  void need(const std::vector<Wish>& wishes);
  void find(bool waits, Wish& wish);

  const Floor& floor_;
  const MeasuringOptions options_;
  DistanceTables& tables_;
};

}  // namespace fleet
