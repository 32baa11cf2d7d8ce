// SPDX-License-Identifier: Apache-2.0
//
// Room for a robot between what stands around it, the legs of storage units above all: one that was
// pushed aside leaves less of it than one in its place.
#pragma once

#include "core/state/views/scene.h"

namespace kiva {

/// Returns whether the robot, standing or turning at (x, y), would touch anything but the legs of a
/// storage unit beneath which it could stand.
bool isFree(const Scene& world, int robot, double x, double y);

/// Returns whether a leg of that unit stands in the lane in which the robot, without a load, drives
/// its segment.
bool standsInLane(const Scene& world, const Model& unit, int robot);

/// What a robot is to have room among: storage units that stand, or all that would stop it, too.
enum class Among { kUnits, kAll };

/// Between which headings [rad] a robot can turn in place without touching anything, and which
/// models end that on both sides; -1 = none.
struct TurnRoom {
  double least = -1e9, most = 1e9;
  int at_least = -1, at_most = -1;
  bool holds(double yaw) const { return yaw >= least && yaw <= most; }
};
/// Up to one turn around from that pose. What the robot touches there is let be unless it comes
/// nearer.
TurnRoom roomToTurn(const Scene& world, int robot, const PlanarPose& at, Among among);

/// Returns whether the robot could turn to any heading there without touching anything.
bool hasRoomToTurn(const Scene& world, int robot, double x, double y);

/// Returns whether no leg of a storage unit stands in a robot's way that drives so far along its
/// heading [m], in reverse if that is < 0, with `margin` more than its width on both sides [m].
bool isWayFree(const Scene& world, int robot, const PlanarPose& from, double way, double margin);

}  // namespace kiva
