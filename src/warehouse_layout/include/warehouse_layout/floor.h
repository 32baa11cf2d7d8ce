// SPDX-License-Identifier: Apache-2.0
//
// Cells of the grid that a fleet drives on, and the two static graphs over them. A robot without a
// load drives on the deck beneath the storage units, one with a load on the aisles alone.
#pragma once

#include <cstdint>
#include <stdexcept>
#include <string>
#include <vector>

namespace layout {

/// Row-major index of a cell: y * width + x.
using Cell = std::int32_t;
constexpr Cell kNowhere = -1;

/// Quarter turns from the grid's x axis towards its y axis: +x, +y, -x, -y.
using Heading = std::uint8_t;
constexpr int kHeadings = 4;

constexpr Heading turned(int heading, int quarters) {
  return static_cast<Heading>((heading + quarters) & 3);
}

/// The graph that a robot drives on.
enum class Deck : std::uint8_t {
  kUnder = 0,   ///< unloaded: the whole floor, beneath storage units too
  kAisles = 1,  ///< loaded: all but storage places, except the robot's own
};

/// Thrown for a floor that can't be planned on; the message has the place and the expectation.
struct FloorError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A description of a floor. All vectors have width * height elements, or are empty where a default
/// is named.
struct FloorDescription {
  int width = 0;                       ///< cells along x
  int height = 0;                      ///< cells along y
  std::vector<std::uint8_t> passable;  ///< 1 where a robot can stand
  std::vector<std::uint8_t> storage;   ///< 1 where a storage unit can stand (default: nowhere)
  std::vector<std::uint8_t>
      parking;                     ///< 1 where only robots without a load may go (default: nowhere)
  std::vector<std::uint8_t> lane;  ///< 1 in the one-way lane of a station (default: nowhere)
  std::vector<std::uint8_t>
      exits;  ///< bit h: the cell may be left towards heading h (default: all)
};

/// Cells and their neighbours. Immutable: temporary obstacles (a broken robot, a closed cell) are
/// passed to each planning step.
class Floor {
 public:
  /// Throws FloorError if the size or the length of a vector is wrong.
  explicit Floor(const FloorDescription& description);

  int width() const { return width_; }
  int height() const { return height_; }
  Cell size() const { return width_ * height_; }
  int x(Cell cell) const { return cell % width_; }
  int y(Cell cell) const { return cell / width_; }
  bool has(Cell cell) const { return cell >= 0 && cell < size(); }
  bool isPassable(Cell cell) const { return passable_[cell]; }
  /// Returns whether loaded robots drive there only at the begin or the end of their way.
  bool isStorage(Cell cell) const { return storage_[cell]; }
  bool isParking(Cell cell) const { return parking_[cell]; }
  bool isLane(Cell cell) const { return lane_[cell]; }

  /// Returns the cell beside `cell` in that heading; kNowhere where the deck has no such edge.
  Cell next(Deck deck, Cell cell, int heading) const {
    return next_[static_cast<int>(deck)][cell * kHeadings + heading];
  }
  /// Returns next() of every cell and heading, size() * kHeadings elements.
  const std::vector<Cell>& edges(Deck deck) const { return next_[static_cast<int>(deck)]; }

  /// Returns the neighbour on the grid, passable or not; kNowhere beyond the edge.
  Cell beside(Cell cell, int heading) const;

  /// Returns "(x, y)", for messages.
  std::string name(Cell cell) const;

 private:
  int width_, height_;
  std::vector<std::uint8_t> passable_, storage_, parking_, lane_;
  std::vector<Cell> next_[2];
};

/// Returns whether a robot on its way to `goal` would enter a station's lane there without need:
/// lanes are no short cuts.
inline bool isPassingThrough(const Floor& floor, Cell from, Cell to, Cell goal) {
  return floor.isLane(to) && !floor.isLane(from) && (goal == kNowhere || !floor.isLane(goal));
}

/// Returns the number of steps of the shortest way over a deck, which may begin and end at a
/// storage place; -1 if there is none.
int shortest(const Floor& floor, Deck deck, Cell from, Cell to);

}  // namespace layout
