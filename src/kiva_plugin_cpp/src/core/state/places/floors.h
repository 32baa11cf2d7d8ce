// SPDX-License-Identifier: Apache-2.0
//
// The surfaces of static models on which wheels can drive. Worlds have their floor as a plane, as a
// box, or as a part of a building's mesh, and not always with its top at zero.
#pragma once

#include "core/state/views/scene.h"

namespace kiva {

/// Smallest area of a floor [m2]; smaller level faces are objects on a floor.
constexpr double kRoom = 9;

/// Largest difference in height within one level surface [m].
constexpr double kSameHeight = 0.005;

/// Largest step that wheels can climb [m].
constexpr double kStep = 0.03;

/// Returns whether a static model is only floor: a plane, or flat and near the ground.
bool isFloor(const ModelInstance& instance);

/// Returns the level surfaces of a static model that may be floor.
std::vector<LevelSurface> levelSurfaces(const ModelDescription& description, const Pose& pose);

/// Returns a static model's bodies. Parts at the floor are in a group that robots don't touch.
ModelBodies buildStatic(const Scene& world, const Model& model);

/// Returns whether an object that rises to `top` in world [m] is low enough to drive over.
inline bool isLow(const FloorExtent& floor, double top) { return top <= floor.z + kStep + 1e-9; }

/// Raises a storage unit that would stand in the floor onto it.
void raiseToFloor(const Scene& world, StorageUnit* unit, Model* model);

/// The surfaces of the floor and their friction.
class FloorCover {
 public:
  explicit FloorCover(const Scene& world);
  /// Returns whether the square around (x, y) with edges of twice `half` [m] lies on them.
  bool covers(double x, double y, double half) const;
  /// Returns the Coulomb coefficient of the uppermost surface at (x, y). Of surfaces of one height,
  /// such as a slab set into a floor, the smallest counts. Returns `otherwise` off all floors.
  double frictionAt(double x, double y, double otherwise) const;
  /// Returns the smallest coefficient of the surfaces that a rectangle meets, or `otherwise` if
  /// that is smaller.
  double leastFriction(const FloorPatch& area, double otherwise) const;

 private:
  struct Piece {
    std::array<Vector3, 4>
        corners;  // convex outline, counterclockwise; a triangle repeats the last corner
    double min_x, max_x, min_y, max_y;
    double z, area;  // height, and area of the whole surface
    double friction;
  };
  void add(const Collision& collision, const Pose& pose, const FloorExtent& floor);
  void fillRows();
  int rowOf(double y) const;
  bool covers(double x, double y) const;
  static bool isInside(const Piece& piece, double x, double y);
  static bool meets(const Piece& piece, const FloorPatch& area);
  bool isCovered(const Piece& piece, const FloorPatch& area) const;
  static bool isAbove(const Piece& piece, const Piece& other);
  std::vector<Piece> pieces_;
  std::vector<std::vector<int>> rows_;  // indices of pieces, by metre of y from below
};

}  // namespace kiva
