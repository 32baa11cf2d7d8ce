// SPDX-License-Identifier: Apache-2.0
//
// The footprints of models' collision shapes among the obstacles; they follow the models' poses.
#pragma once

#include "core/geometry/footprint.h"
#include "core/state/views/motion_view.h"

namespace kiva {

/// Gives a model the geometry of its collision shapes, still without footprints.
void addCollisionGeometry(const FloorState& floor, Model& model);
/// Renews the geometry of a static model after it or the floor has moved.
void refitGeometry(MotionView& world, Model& model);
/// Updates the footprints of a model, or of a robot with its load, after a move or a change of
/// shape, and counts up World::unitsRevision for units and items. Every move of a model calls this,
/// and needs nothing else.
void moved(MotionView& world, Model& model);
/// Updates the footprints of a robot that drove by itself in this step.
void followRobot(const FleetState& fleet, Obstacles& obstacles, Storage& storage, int robot);
/// Raises the footprints of a robot's load, if it has one [m].
void raiseLoad(const FleetState& fleet, Obstacles& obstacles, Storage& storage, int robot,
               double by);
/// Removes the footprints; the model keeps its geometry.
void hideFootprints(Obstacles& obstacles, Model& model);
/// Discards the clearances of all robots, after something was added or moved from outside: robots
/// test their ways before they go on.
void invalidateClearance(FleetState& fleet);

/// Calls visit(footprint) for each of the model's footprints in world.
template <typename Visit>
void forFootprints(const Scene& world, int slot, Visit visit) {
  const Model& model = *world.models[slot];
  const int mover = model.owner->robot(world, model);
  if (mover < 0) {
    for (const CollisionGeometry& g : model.geometries) visit(world.obstacles[g.handle]);
    return;
  }
  for (const Footprint& footprint : world.obstacles.footprints(mover)) {
    if (footprint.model == slot) visit(footprint);
  }
}

/// Returns whether two footprints overlap in height.
inline bool shareHeight(const Footprint& a, const Footprint& b) {
  return a.z_min <= b.z_max && b.z_min <= a.z_max;
}

/// Returns half the length and width of a robot with its load, along its axes [m].
inline double halfLength(const Robot& r) { return std::max(r.half_length, r.load_half_length); }
inline double halfWidth(const Robot& r) { return std::max(r.half_width, r.load_half_width); }
/// Returns the distance from its centre to the farthest corner of both [m].
inline double cornerRadius(const Robot& r) { return std::hypot(halfLength(r), halfWidth(r)); }
/// Returns the height above the floor up to which robot `i` reaches; unlimited with a load [m].
inline double heightOf(const Fleet& f, int i) {
  return f.unit[i] < 0 ? f.robots[i].height + f.tower[i] : 1e9;
}

}  // namespace kiva
