// SPDX-License-Identifier: Apache-2.0
#include "core/floor/streets.h"

namespace fleet {

namespace {

constexpr int kShortest = 16;    // [cells]; shorter ones lie in random maps by chance
constexpr double kNarrow = 0.4;  // least share of cells with no passable cell on either side

/// The floor as parallel lines of cells along a heading.
class Lines {
 public:
  Lines(const Floor& floor, bool along_y) : floor_(floor), along_y_(along_y) {}

  int count() const { return along_y_ ? floor_.width() : floor_.height(); }
  int length() const { return along_y_ ? floor_.height() : floor_.width(); }
  Cell cell(int line, int place) const {
    return along_y_ ? place * floor_.width() + line : line * floor_.width() + place;
  }
  int forwards() const { return along_y_ ? 1 : 0; }
  bool isPassable(int line, int place) const {
    return line >= 0 && line < count() && floor_.isPassable(cell(line, place));
  }
  bool isNarrow(int line, int place) const {
    return !isPassable(line - 1, place) && !isPassable(line + 1, place);
  }

 private:
  const Floor& floor_;
  bool along_y_;
};

/// Places [begin, end) of a line.
struct Stretch {
  int begin = 0, end = 0;
};

std::vector<Stretch> streetsOf(const Lines& lines, int line) {
  std::vector<Stretch> out;
  for (int place = 0; place < lines.length(); ++place) {
    const int begin = place;
    int narrow = 0;
    for (; place < lines.length() && lines.isPassable(line, place); ++place) {
      narrow += lines.isNarrow(line, place);
    }
    const int length = place - begin;
    if (length >= kShortest && narrow >= kNarrow * length) out.push_back({begin, place});
  }
  return out;
}

}  // namespace

std::vector<StreetWay> streetWays(const Floor& floor) {
  std::vector<StreetWay> ways(floor.size() * kHeadings, StreetWay::kNone);
  for (const bool along_y : {false, true}) {
    const Lines lines(floor, along_y);
    int direction = lines.forwards();
    for (int line = 0; line < lines.count(); ++line) {
      const std::vector<Stretch> streets = streetsOf(lines, line);
      for (const Stretch& street : streets) {
        for (int place = street.begin; place < street.end; ++place) {
          StreetWay* of_cell = &ways[lines.cell(line, place) * kHeadings];
          of_cell[direction] = StreetWay::kAlong;
          of_cell[turned(direction, 2)] = StreetWay::kAgainst;
        }
      }
      if (!streets.empty()) direction = turned(direction, 2);  // of the next line with streets
    }
  }
  return ways;
}

}  // namespace fleet
