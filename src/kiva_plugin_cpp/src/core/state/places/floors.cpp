// SPDX-License-Identifier: Apache-2.0
#include "core/state/places/floors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <mutex>
#include <tuple>

#include "core/geometry/footprint.h"
#include "core/geometry/triangle_footprint.h"

namespace kiva {
namespace {

constexpr double kLevel = 0.9994;    // cosine of 2°
constexpr double kNearGround = 0.1;  // [m] around z = 0 in which a floor may be
constexpr double kRim = 1e-6;        // [m]
constexpr double kMostRows = 4096;   // rows of a metre, half of them on each side of y = 0

/// A convex, level outline seen from above, counterclockwise; a triangle repeats its last corner.
using Outline = std::array<Vector3, 4>;

double areaOf(const Outline& o) {
  const Vector3 a = o[2] - o[0], b = o[3] - o[1];
  return 0.5 * std::abs(a.X() * b.Y() - a.Y() * b.X());
}

Outline counterclockwise(Outline o) {
  const Vector3 a = o[1] - o[0], b = o[2] - o[1];
  if (a.X() * b.Y() - a.Y() * b.X() < 0) std::reverse(o.begin(), o.end());
  return o;
}

/// Calls visit(outline) for every level face of a shape; a mesh may be wound either way.
template <typename Visit>
void forLevelFaces(const Shape& shape, const Pose& pose, Visit visit) {
  const Bounds box = bounds(shape, pose);
  if (shape.kind == Shape::Kind::kPlane) {
    if (pose.Rot().RotateVector(shape.normal).Z() < kLevel) return;
    visit(Outline{{{box.min.X(), box.min.Y(), pose.Z()},
                   {box.max.X(), box.min.Y(), pose.Z()},
                   {box.max.X(), box.max.Y(), pose.Z()},
                   {box.min.X(), box.max.Y(), pose.Z()}}});
  } else if (shape.kind == Shape::Kind::kBox) {
    const Vector3 axes[3] = {pose.Rot().XAxis(), pose.Rot().YAxis(), pose.Rot().ZAxis()};
    for (int up = 0; up < 3; ++up) {
      if (std::abs(axes[up].Z()) < kLevel) continue;
      const int along = (up + 1) % 3, across = (up + 2) % 3;
      const Vector3 x = axes[along] * (shape.size[along] / 2);
      const Vector3 y = axes[across] * (shape.size[across] / 2);
      const Vector3 top(pose.X(), pose.Y(), box.max.Z());
      visit(counterclockwise({top - x - y, top + x - y, top + x + y, top - x + y}));
    }
  } else if (shape.kind == Shape::Kind::kMesh) {
    for (std::size_t i = 0; i < shape.mesh->triangles.size(); ++i) {
      const Triangle t = cornersOf(*shape.mesh, static_cast<int>(i), pose);
      const Vector3 normal = (t[1] - t[0]).Cross(t[2] - t[0]);
      if (std::abs(normal.Z()) < kLevel * normal.Length()) continue;
      visit(counterclockwise({t[0], t[1], t[2], t[2]}));
    }
  }
}

double heightOf(const Outline& o) { return std::max({o[0].Z(), o[1].Z(), o[2].Z(), o[3].Z()}); }

void widen(LevelSurface* surface, const Outline& outline) {
  for (const Vector3& corner : outline) {
    surface->min_x = std::min(surface->min_x, corner.X());
    surface->max_x = std::max(surface->max_x, corner.X());
    surface->min_y = std::min(surface->min_y, corner.Y());
    surface->max_y = std::max(surface->max_y, corner.Y());
  }
}

/// Returns `mesh` with its low triangles, or with all others; null if there are none.
std::shared_ptr<const Mesh> halfOf(const std::shared_ptr<const Mesh>& mesh, const Pose& pose,
                                   const FloorExtent& floor, bool low) {
  std::vector<std::array<int, 3>> triangles;
  for (std::size_t i = 0; i < mesh->triangles.size(); ++i) {
    const Triangle t = cornersOf(*mesh, static_cast<int>(i), pose);
    const double top = std::max({t[0].Z(), t[1].Z(), t[2].Z()});
    if (isLow(floor, top) == low) triangles.push_back(mesh->triangles[i]);
  }
  if (triangles.empty()) return nullptr;
  if (triangles.size() == mesh->triangles.size()) return mesh;
  return std::make_shared<const Mesh>(
      Mesh{mesh->vertices, std::move(triangles), mesh->min, mesh->max});
}

/// A cache of these halves, for all models with that mesh at one height and tilt.
class Halves {
 public:
  std::shared_ptr<const Mesh> of(const std::shared_ptr<const Mesh>& mesh, const Pose& pose,
                                 const FloorExtent& floor, bool low) {
    const Vector3 up = pose.Rot().RotateVectorReverse(Vector3::UnitZ);
    const Key key{mesh.get(), low, {up.X(), up.Y(), up.Z(), pose.Z() - floor.z}};
    const std::lock_guard<std::mutex> lock(mutex_);
    const auto entry = known_.find(key);
    if (entry != known_.end() && entry->second.whole.lock() == mesh) {
      const auto half = entry->second.half.lock();
      if (half || entry->second.is_none) return half;
    }
    const auto half = halfOf(mesh, pose, floor, low);
    forget();
    known_[key] = {mesh, half, !half};
    return half;
  }

 private:
  struct Key {
    const Mesh* mesh;
    bool low;
    std::array<double, 4> place;  // the world's vertical in the mesh's frame, and its height
    bool operator<(const Key& o) const {
      return std::tie(mesh, low, place) < std::tie(o.mesh, o.low, o.place);
    }
  };
  struct Entry {
    std::weak_ptr<const Mesh> whole, half;
    bool is_none = false;
  };

  /// Drops entries whose mesh no longer exists.
  void forget() {
    for (auto at = known_.begin(); at != known_.end();) {
      at = at->second.whole.expired() ? known_.erase(at) : std::next(at);
    }
  }

  std::mutex mutex_;
  std::map<Key, Entry> known_;
};

/// Returns the low part of a collision, or the other one; nothing if it is empty.
std::optional<Collision> partOf(const Collision& whole, const Pose& link, const FloorExtent& floor,
                                bool low) {
  const Pose pose = link * whole.pose_in_link;
  const Bounds box = bounds(whole.shape, pose);
  const bool is_plane = whole.shape.kind == Shape::Kind::kPlane;
  if (is_plane || isLow(floor, box.max.Z())) return low ? std::optional(whole) : std::nullopt;
  if (whole.shape.kind != Shape::Kind::kMesh || !isLow(floor, box.min.Z())) {
    return low ? std::nullopt : std::optional(whole);
  }
  Collision part = whole;
  static Halves halves;
  part.shape.mesh = halves.of(whole.shape.mesh, pose, floor, low);
  return part.shape.mesh ? std::optional(part) : std::nullopt;
}

ModelDescription partOf(const Model& model, const FloorExtent& floor, bool low) {
  ModelDescription part = *model.description;
  for (Link& link : part.links) {
    std::vector<Collision> collisions;
    for (const Collision& whole : link.collisions) {
      auto kept = partOf(whole, model.pose * link.pose_in_model, floor, low);
      if (kept) collisions.push_back(std::move(*kept));
    }
    link.collisions = std::move(collisions);
  }
  return part;
}

}  // namespace

std::vector<LevelSurface> levelSurfaces(const ModelDescription& description, const Pose& pose) {
  std::map<std::tuple<bool, long long, double>, LevelSurface> by_height;
  for (const Link& link : description.links) {
    for (const Collision& collision : link.collisions) {
      const Pose at = pose * link.pose_in_model * collision.pose_in_link;
      forLevelFaces(collision.shape, at, [&](const Outline& face) {
        const double z = heightOf(face);
        const bool is_plane = collision.shape.kind == Shape::Kind::kPlane;
        if (!is_plane && std::abs(z) > kNearGround) return;
        auto [entry, is_new] =
            by_height.try_emplace({is_plane, std::llround(z / kSameHeight), collision.friction});
        LevelSurface& surface = entry->second;
        surface.is_plane = is_plane;
        surface.friction = collision.friction;
        surface.z = is_new ? z : std::max(surface.z, z);
        surface.area += areaOf(face);
        widen(&surface, face);
      });
    }
  }
  std::vector<LevelSurface> surfaces;
  for (const auto& [key, surface] : by_height) surfaces.push_back(surface);
  return surfaces;
}

bool isFloor(const ModelInstance& instance) {
  const ModelDescription& description = *instance.description;
  if (!description.is_static) return false;
  Bounds all;
  for (const Link& link : description.links) {
    for (const Collision& collision : link.collisions) {
      if (collision.shape.kind == Shape::Kind::kPlane) return true;
      all.add(bounds(collision.shape, instance.pose * link.pose_in_model * collision.pose_in_link));
    }
  }
  if (all.empty() || all.max.Z() > kNearGround) return false;
  const auto surfaces = levelSurfaces(description, instance.pose);
  return all.max.Z() <= kStep || std::any_of(surfaces.begin(), surfaces.end(),
                                             [](const auto& s) { return s.area >= kRoom; });
}

ModelBodies buildStatic(const Scene& world, const Model& model) {
  // Static bodies do not touch each other.
  const int mask = ~(kFloorGroup | kStaticGroup);
  const auto build = [&](bool low, int group) {
    return world.physics.build(partOf(model, world.floor.extent, low), model.pose, model.slot,
                               group, mask);
  };
  ModelBodies bodies = build(false, kStaticGroup), floor = build(true, kFloorGroup);
  for (auto* list : {&floor.links, &floor.surfaces}) {
    for (LinkBody& link : *list) {
      const bool is_empty = !link.surface && link.shape.parts.empty();
      if (!is_empty) bodies.surfaces.push_back(std::move(link));
    }
  }
  return bodies;
}

void raiseToFloor(const Scene& world, StorageUnit* unit, Model* model) {
  const double depth = world.floor.extent.z - model->pose.Z();
  if (depth <= 0 || depth > kNearGround) return;
  model->pose.Pos().Z() = model->spawn_pose.Pos().Z() = world.floor.extent.z;
  unit->raised += depth;
}

FloorCover::FloorCover(const Scene& world) {
  for (const auto& model : world.models) {
    if (!model || model->level_surfaces.empty()) continue;
    for (const Link& link : model->description->links) {
      for (const Collision& collision : link.collisions) {
        add(collision, model->pose * link.pose_in_model * collision.pose_in_link,
            world.floor.extent);
      }
    }
  }
  if (!pieces_.empty()) fillRows();
}

void FloorCover::add(const Collision& collision, const Pose& pose, const FloorExtent& floor) {
  const std::size_t first = pieces_.size();
  double area = 0;
  forLevelFaces(collision.shape, pose, [&](const Outline& face) {
    const double z = heightOf(face);
    if (std::abs(z - floor.z) > kStep + 1e-9) return;
    const auto [min_x, max_x] = std::minmax({face[0].X(), face[1].X(), face[2].X(), face[3].X()});
    const auto [min_y, max_y] = std::minmax({face[0].Y(), face[1].Y(), face[2].Y(), face[3].Y()});
    pieces_.push_back({face, min_x, max_x, min_y, max_y, z, 0, collision.friction});
    area += areaOf(face);
  });
  const bool is_plane = collision.shape.kind == Shape::Kind::kPlane;
  for (std::size_t i = first; i < pieces_.size(); ++i) {
    pieces_[i].area = is_plane ? std::numeric_limits<double>::infinity() : area;
  }
}

void FloorCover::fillRows() {
  rows_.resize(static_cast<std::size_t>(kMostRows) + 1);
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    for (int row = rowOf(pieces_[i].min_y); row <= rowOf(pieces_[i].max_y); ++row) {
      rows_[row].push_back(static_cast<int>(i));
    }
  }
}

int FloorCover::rowOf(double y) const {
  return static_cast<int>(std::floor(std::clamp(y, -kMostRows / 2, kMostRows / 2) + kMostRows / 2));
}

bool FloorCover::isAbove(const Piece& piece, const Piece& other) {
  if (std::abs(piece.z - other.z) > kSameHeight) return piece.z > other.z;
  return piece.area < other.area;
}

double FloorCover::frictionAt(double x, double y, double otherwise) const {
  const Piece* top = nullptr;
  if (rows_.empty() || std::abs(y) > kMostRows / 2) return otherwise;
  for (const int i : rows_[rowOf(y)]) {
    const Piece& piece = pieces_[i];
    if ((!top || isAbove(piece, *top)) && isInside(piece, x, y)) top = &piece;
  }
  return top ? top->friction : otherwise;
}

double FloorCover::leastFriction(const FloorPatch& area, double otherwise) const {
  double least = otherwise;
  if (rows_.empty()) return least;
  for (int row = rowOf(area.min_y); row <= rowOf(area.max_y); ++row) {
    for (const int i : rows_[row]) {
      const Piece& piece = pieces_[i];
      if (piece.friction >= least || !meets(piece, area) || isCovered(piece, area)) continue;
      least = piece.friction;
    }
  }
  return least;
}

/// They meet unless the rectangle is completely beyond one side of the outline, or of its bounds.
bool FloorCover::meets(const Piece& piece, const FloorPatch& area) {
  if (!area.meets({piece.min_x, piece.max_x, piece.min_y, piece.max_y, 0})) return false;
  for (int i = 0; i < 4; ++i) {
    const Vector3& a = piece.corners[i];
    const Vector3 along = piece.corners[(i + 1) % 4] - a;
    // The corner of the rectangle farthest to the left of that side, where the inside is.
    const double x = along.Y() < 0 ? area.max_x : area.min_x;
    const double y = along.X() > 0 ? area.max_y : area.min_y;
    if (along.X() * (y - a.Y()) - along.Y() * (x - a.X()) < 0) return false;
  }
  return true;
}

/// Returns whether the part of a piece in a rectangle lies beneath one other piece. That is convex:
/// it covers the part if it covers its corners.
bool FloorCover::isCovered(const Piece& piece, const FloorPatch& area) const {
  const double min_x = std::max(piece.min_x, area.min_x), max_x = std::min(piece.max_x, area.max_x);
  const double min_y = std::max(piece.min_y, area.min_y), max_y = std::min(piece.max_y, area.max_y);
  const auto& row = rows_[rowOf(min_y)];
  return std::any_of(row.begin(), row.end(), [&](int i) {
    const Piece& other = pieces_[i];
    return isAbove(other, piece) && isInside(other, min_x, min_y) &&
           isInside(other, max_x, min_y) && isInside(other, min_x, max_y) &&
           isInside(other, max_x, max_y);
  });
}

bool FloorCover::covers(double x, double y, double half) const {
  const double h = half - kRim;
  return covers(x, y) && covers(x - h, y - h) && covers(x - h, y + h) && covers(x + h, y - h) &&
         covers(x + h, y + h);
}

bool FloorCover::covers(double x, double y) const {
  if (rows_.empty() || std::abs(y) > kMostRows / 2) return false;
  const auto& row = rows_[rowOf(y)];
  return std::any_of(row.begin(), row.end(),
                     [&](int piece) { return isInside(pieces_[piece], x, y); });
}

bool FloorCover::isInside(const Piece& piece, double x, double y) {
  if (x < piece.min_x || x > piece.max_x || y < piece.min_y || y > piece.max_y) return false;
  for (int i = 0; i < 4; ++i) {
    const Vector3& a = piece.corners[i];
    const Vector3& b = piece.corners[(i + 1) % 4];
    const double side = (b.X() - a.X()) * (y - a.Y()) - (b.Y() - a.Y()) * (x - a.X());
    if (side < -kRim) return false;
  }
  return true;
}

}  // namespace kiva
