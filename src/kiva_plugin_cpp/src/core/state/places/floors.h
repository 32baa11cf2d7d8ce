// SPDX-License-Identifier: Apache-2.0
//
// What of the static models wheels can drive on. Worlds have their floor as a plane, as a box, or
// as a part of the mesh of a whole building, and not always with its top at zero.
#pragma once

#include "core/state/views/scene.h"

namespace kiva {

/// What is smaller than that on a plane is a thing that lies there [m2].
constexpr double kRoom = 9;

/// Level surfaces whose heights differ by less are one [m].
constexpr double kSameHeight = 0.005;

/// How much higher than the floor something may rise for wheels to get over it [m].
constexpr double kStep = 0.03;

/// Returns whether a static model is floor and nothing else: a plane, or what is flat and near the
/// ground.
bool isFloor(const ModelInstance& instance);

/// Returns the level surfaces of a static model that may be floor.
std::vector<LevelSurface> levelSurfaces(const ModelDescription& description, const Pose& pose);

/// Returns a static model's bodies: what lies at the floor is in a group that robots don't touch.
ModelBodies buildStatic(const Scene& world, const Model& model);

/// Returns whether what rises to `top` in world [m] is low enough to drive over.
inline bool isLow(const Floor& floor, double top) { return top <= floor.z + kStep + 1e-9; }

/// Puts a storage unit that would stand in the floor on it.
void raiseToFloor(const Scene& world, StorageUnit* unit, Model* model);

/// Where the surfaces of the floor lie, and how they grip.
class FloorCover {
 public:
  explicit FloorCover(const Scene& world);
  /// Returns whether the square around (x, y) with edges of twice `half` [m] lies on them.
  bool covers(double x, double y, double half) const;
  /// Returns the Coulomb coefficient of the uppermost surface at (x, y); of surfaces of one height
  /// the smallest counts, as a slab that is set into a floor. `otherwise` where there is none.
  double frictionAt(double x, double y, double otherwise) const;
  /// Returns the least one of the surfaces that a rectangle meets, or `otherwise` if that is less.
  double leastFriction(const FloorPatch& area, double otherwise) const;

 private:
  struct Piece {
    std::array<Vector3, 4> corners;  // of a convex outline, counterclockwise; the last may be twice
    double min_x, max_x, min_y, max_y;
    double z, area;  // the latter of the whole surface that it is of
    double friction;
  };
  void add(const Collision& collision, const Pose& pose, const Floor& floor);
  void fillRows();
  int rowOf(double y) const;
  bool covers(double x, double y) const;
  static bool isInside(const Piece& piece, double x, double y);
  static bool meets(const Piece& piece, const FloorPatch& area);
  bool isCovered(const Piece& piece, const FloorPatch& area) const;
  static bool isAbove(const Piece& one, const Piece& other);
  std::vector<Piece> pieces_;
  std::vector<std::vector<int>> rows_;  // indices of pieces, by metre of y from below
};

}  // namespace kiva
