// SPDX-License-Identifier: Apache-2.0
//
// Room for a robot between the models around it, above all the legs of storage units. A unit that
// was pushed aside leaves less room than one in its place.
#pragma once

#include "core/state/views/scene.h"

namespace kiva {

/// Returns whether the robot, standing or turning at (x, y), would touch nothing but legs of a
/// storage unit beneath which it could stand.
bool isFree(const Scene& world, int robot, double x, double y);

/// Returns whether a leg of that unit stands in the lane in which the robot, without a load, drives
/// its segment.
bool standsInLane(const Scene& world, const Model& unit, int robot);

/// The models among which a robot needs room: standing storage units, or also all others that would
/// stop it.
enum class Among { kUnits, kAll };

/// The headings [rad] between which a robot can turn in place without touching anything, and the
/// models that limit it on both sides; -1 = none.
struct TurnRoom {
  double least = -1e9, most = 1e9;
  int at_least = -1, at_most = -1;
  bool holds(double yaw) const { return yaw >= least && yaw <= most; }
};
/// Returns the room for a turn by up to 360° from that pose. Models that the robot touches at that
/// pose are ignored unless it comes nearer to them.
TurnRoom roomToTurn(const Scene& world, int robot, const PlanarPose& at, Among among);

/// Returns whether the robot could turn to any heading there without touching anything.
bool hasRoomToTurn(const Scene& world, int robot, double x, double y);

/// Returns whether no leg of a storage unit stands in the way of a robot that drives that distance
/// along its heading [m], in reverse if it is < 0, with `margin` [m] on both sides.
bool isWayFree(const Scene& world, int robot, const PlanarPose& from, double way, double margin);

}  // namespace kiva
