// SPDX-License-Identifier: Apache-2.0
#include "core/state/places/footprints.h"

#include <algorithm>

#include "core/geometry/triangle_footprint.h"
#include "core/state/places/floors.h"
#include "core/state/places/poses.h"

namespace kiva {
namespace {

/// Adds the triangles of a building's mesh that are obstacles; those of its floor are not.
void addTriangles(const FloorExtent& floor, Model& model, CollisionGeometry geometry) {
  const Mesh& mesh = *geometry.shape.mesh;
  const Pose pose =
      model.pose * model.description->links[geometry.link].pose_in_model * geometry.pose_in_link;
  geometry.shape.mesh_file.clear();  // once, not for each triangle
  model.geometries.reserve(model.geometries.size() + mesh.triangles.size());
  for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
    geometry.triangle = static_cast<int>(i);
    geometry.corners = std::make_shared<Triangle>(cornersOf(mesh, geometry.triangle, pose));
    const Footprint flat = makeFootprint(*geometry.corners);
    if (!isLow(floor, flat.z_max)) model.geometries.push_back(geometry);
  }
}

/// Returns the top of a geometry in world [m].
double topOf(const Model& model, const CollisionGeometry& geometry) {
  const Pose link = model.pose * model.description->links[geometry.link].pose_in_model;
  return bounds(geometry.shape, link * geometry.pose_in_link).max.Z();
}

/// Appends the footprints of one model, of `group`, in the frame whose inverse is `to_frame`.
void appendFootprints(const Scene& world, const Model& model, const Pose& to_frame, int group,
                      std::vector<Footprint>* out) {
  constexpr int kNone = -2;  // -1 is a robot's base
  int link = kNone;
  Pose link_in_frame;  // mostly shared by several geometries
  out->reserve(out->size() + model.geometries.size());
  for (const CollisionGeometry& geometry : model.geometries) {
    if (geometry.link != link) {
      link = geometry.link;
      link_in_frame =
          to_frame * (link < 0 ? basePose(world, model.index) : linkPose(world, model, link));
    }
    const Pose pose = link_in_frame * geometry.pose_in_link;
    Footprint footprint;
    if (geometry.triangle >= 0) {
      *geometry.corners = cornersOf(*geometry.shape.mesh, geometry.triangle, pose);
      footprint = makeFootprint(*geometry.corners);
    } else {
      footprint = makeFootprint(geometry.shape, pose);
    }
    footprint.model = model.slot;
    footprint.group = group;
    if (footprint.kind == Footprint::Kind::kOther && model.in_physics) {
      footprint.body = model.bodies.links[std::max(0, geometry.link)].body.get();
    }
    out->push_back(footprint);
  }
}

/// Updates the footprints of a robot with its load, which move as one.
void updateMover(const Scene& world, Obstacles& obstacles, int robot) {
  const Pose to_robot =
      Pose(0, 0, world.floor.extent.z, 0, 0, 0) * basePose(world, robot).Inverse();
  std::vector<Footprint> local;
  appendFootprints(world, world.models.of(world.fleet.robots[robot]), to_robot, robot, &local);
  const int unit = world.fleet.unit[robot];
  if (unit >= 0) {
    appendFootprints(world, *world.models[world.storage.units[unit].model], to_robot, robot,
                     &local);
  }
  obstacles.setMover(robot, std::move(local));
}

void updateStanding(const Scene& world, Obstacles& obstacles, Model& model) {
  std::vector<Footprint> footprints;
  appendFootprints(world, model, Pose::Zero, model.owner->group(model), &footprints);
  for (std::size_t k = 0; k < footprints.size(); ++k) {
    int& handle = model.geometries[k].handle;
    if (handle < 0) {
      handle = obstacles.add(footprints[k]);
    } else {
      obstacles.update(handle, footprints[k]);
    }
  }
}

}  // namespace

void refitGeometry(MotionView& world, Model& model) {
  hideFootprints(world.obstacles, model);
  model.geometries.clear();
  addCollisionGeometry(world.floor, model);
  moved(world, model);
}

void addCollisionGeometry(const FloorState& floor, Model& model) {
  const auto& links = model.description->links;
  if (model.isStatic()) model.level_surfaces = levelSurfaces(*model.description, model.pose);
  std::size_t collisions = 0;
  for (const Link& link : links) collisions += link.collisions.size();
  model.geometries.reserve(collisions);
  for (std::size_t i = 0; i < links.size(); ++i) {
    for (const Collision& collision : links[i].collisions) {
      if (collision.shape.kind == Shape::Kind::kPlane) continue;
      const CollisionGeometry geometry{static_cast<int>(i), collision.pose_in_link,
                                       collision.shape};
      if (collision.shape.kind == Shape::Kind::kMesh && model.isStatic()) {
        addTriangles(floor.extent, model, geometry);
      } else if (!model.isStatic() || !isLow(floor.extent, topOf(model, geometry))) {
        model.geometries.push_back(geometry);
      }
    }
  }
}

void moved(MotionView& world, Model& model) {
  const int mover = model.owner->robot(world, model);
  if (model.owner->isTracked() || (mover >= 0 && world.fleet.unit[mover] >= 0))
    world.storage.noteMove();
  if (mover < 0) return updateStanding(world, world.obstacles, model);
  hideFootprints(world.obstacles, model);  // the unit's own, before it was taken up
  updateMover(world, world.obstacles, mover);
}

void followRobot(const FleetState& f, Obstacles& obstacles, Storage& storage, int robot) {
  const bool still = f.vx[robot] == 0 && f.vy[robot] == 0 && f.yaw_rate[robot] == 0;
  if (still) return;
  obstacles.follow(robot);
  if (f.unit[robot] >= 0) storage.noteMove();
}

void raiseLoad(const FleetState& fleet, Obstacles& obstacles, Storage& storage, int robot,
               double by) {
  const int unit = fleet.unit[robot];
  if (unit < 0) return;
  obstacles.raise(robot, storage.units[unit].model, by);
  storage.noteMove();
}

void hideFootprints(Obstacles& obstacles, Model& model) {
  for (CollisionGeometry& geometry : model.geometries) {
    if (geometry.handle >= 0) obstacles.remove(geometry.handle);
    geometry.handle = -1;
  }
}

void invalidateClearance(FleetState& f) {
  for (auto* column : {&f.clear_until, &f.attend_at, &f.wedged_until}) {
    std::fill(column->begin(), column->end(), 0);
  }
}

}  // namespace kiva
