// SPDX-License-Identifier: Apache-2.0
#include "core/search/reservations.h"

namespace fleet {
namespace {

/// Merges two answers: the other one if one of them is kNone, kSeveral if they differ.
int merged(int robot, int other) {
  if (robot == Reservations::kNobody || robot == other) return other;
  return other == Reservations::kNobody ? robot : Reservations::kSeveral;
}

}  // namespace

Reservations::Reservations(const Floor& floor, const Rules& rules, int horizon)
    : floor_(floor), rules_(rules), horizon_(horizon), table_(floor.size() * kStride, kNobody) {}

void Reservations::begin(const Fleet& fleet) {
  for (int robot = 0; robot < static_cast<int>(standing_.size()); ++robot) {
    remove(robot);
    at(standing_[robot], 0) = kNobody;
  }
  standing_ = fleet.cell;
  paths_.resize(fleet.size());
  is_placed_.assign(fleet.size(), 0);
  is_loaded_.assign(fleet.size(), 0);
  committed_.assign(fleet.size(), 0);
  for (int robot = 0; robot < fleet.size(); ++robot) {
    at(standing_[robot], 0) = robot;
    is_loaded_[robot] = fleet.isLoaded(robot);
    committed_[robot] = fleet.commitments(robot);
  }
}

void Reservations::place(int robot, const Path& path) {
  paths_[robot] = path;
  is_placed_[robot] = 1;
  for (int tick = 1; tick <= horizon_; ++tick) at(path.cells[tick], tick) = robot;
}

void Reservations::remove(int robot) {
  if (!is_placed_[robot]) return;
  is_placed_[robot] = 0;
  for (int tick = 1; tick <= horizon_; ++tick) {
    auto& who = at(paths_[robot].cells[tick], tick);
    if (who == robot) who = kNobody;
  }
}

int Reservations::conflict(int robot, const Path& path) const {
  int who = kNobody;
  for (int tick = 1; tick <= horizon_ && who != kSeveral; ++tick) {
    const Cell from = path.cells[tick - 1], to = path.cells[tick];
    who = merged(who, at(to, tick));
    if (from != to) {
      who = merged(who, entering(robot, from, to, tick));
    } else if (!rules_.turning && is_loaded_[robot] && quarters(path.actions[tick - 1]) != 0) {
      who = merged(who, turning(robot, to, tick));
    }
  }
  return who;
}

/// Returns the conflict with the robot that was there before, and with the one that comes after.
int Reservations::entering(int robot, Cell from, Cell to, int tick) const {
  const int follower = at(from, tick), leaving = at(to, tick - 1);
  const int after = isStrict(follower, tick) ? follower : kNobody;
  if (leaving == kNobody || leaving == robot) return after;
  if (isStrict(robot, tick)) return merged(leaving, after);
  if (follower == leaving) return leaving;  // swap
  const bool is_ring = (!rules_.rings || !rules_.following) && closesRing(robot, from, to, tick);
  return is_ring ? kSeveral : after;
}

/// Returns whether the chain of robots that make way for each other begins with the robot itself.
bool Reservations::closesRing(int robot, Cell from, Cell to, int tick) const {
  for (int leaving = at(to, tick - 1); leaving != kNobody; leaving = at(to, tick - 1)) {
    if (leaving == robot) return true;
    if (!is_placed_[leaving] || paths_[leaving].cells[tick] == to) return false;
    to = paths_[leaving].cells[tick];
    if (to == from) return true;
  }
  return false;
}

/// Returns the loaded robot beside it that turns in the same tick: their units would touch.
int Reservations::turning(int robot, Cell cell, int tick) const {
  int who = kNobody;
  for (int heading = 0; heading < kHeadings; ++heading) {
    const Cell next = floor_.beside(cell, heading);
    if (next == kNowhere) continue;
    const int other = at(next, tick);
    if (other == kNobody || other == robot || !is_loaded_[other]) continue;
    if (quarters(paths_[other].actions[tick - 1]) != 0) who = merged(who, other);
  }
  return who;
}

}  // namespace fleet
