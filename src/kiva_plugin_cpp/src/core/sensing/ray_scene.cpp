// SPDX-License-Identifier: Apache-2.0
#include "core/sensing/ray_scene.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/infinity.h"
#include "core/geometry/ray.h"
#include "core/state/places/poses.h"

namespace kiva {
namespace {

constexpr int kLeaf = 4;        // targets of a leaf
constexpr int kDeepest = 64;    // levels of a tree that is halved at each node
constexpr double kGrow = 1e-6;  // [m], margin of a box against rounding

/// Returns the distance at which a ray enters a box, +inf = not within `range` (Kay and Kajiya
/// 1986).
double enter(const Bounds& box, const Vector3& from, const Vector3& inverse, double range) {
  double first = 0, last = range;
  for (int i = 0; i < 3; ++i) {
    const double a = (box.min[i] - from[i]) * inverse[i];
    const double b = (box.max[i] - from[i]) * inverse[i];
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  return first <= last ? first : kInfinity;
}

double squaredDistance(const Bounds& box, const Vector3& point) {
  double sum = 0;
  for (int i = 0; i < 3; ++i) {
    const double way = std::max({box.min[i] - point[i], 0.0, point[i] - box.max[i]});
    sum += way * way;
  }
  return sum;
}

Shape ellipsoidOf(const Shape& sphere) {
  Shape out;
  out.kind = Shape::Kind::kEllipsoid;
  out.size = Vector3::One * sphere.radius;
  return out;
}

Shape boxAround(const Mesh& mesh) {
  Shape out;
  out.size = mesh.max - mesh.min;
  return out;
}

/// Returns the inverse of each component, finite even where it is 0.
Vector3 inverseOf(const Vector3& direction) {
  constexpr double kLeast = 1e-300;
  Vector3 out;
  for (int i = 0; i < 3; ++i) {
    const double way = direction[i];
    out[i] = 1 / (std::abs(way) < kLeast ? std::copysign(kLeast, way) : way);
  }
  return out;
}

}  // namespace

RayScene::RayScene(const Scene& world, const Vector3& from, double range, const Model* but)
    : from_(from), range_(range) {
  const int robot = but ? but->owner->robot(world, *but) : -1;
  for (const auto& model : world.models) {
    if (!model || model.get() == but) continue;
    if (robot >= 0 && model->owner->robot(world, *model) == robot) continue;
    if (model->isStatic()) {
      addStatic(world, *model);
    } else {
      addMoving(world, *model);
    }
  }
  if (!targets_.empty()) build(0, static_cast<int>(targets_.size()));
}

void RayScene::addStatic(const Scene& world, const Model& model) {
  const auto& links = model.description->links;
  for (std::size_t i = 0; i < links.size(); ++i) {
    const Pose link = linkPose(world, model, static_cast<int>(i));
    for (const Collision& collision : links[i].collisions) {
      const Shape::Kind kind = collision.shape.kind;
      if (kind == Shape::Kind::kPlane || kind == Shape::Kind::kMesh) continue;
      add(collision.shape, link * collision.pose_in_link, nullptr);
    }
  }
  addSurfaces(model);
}

void RayScene::addMoving(const Scene& world, const Model& model) {
  for (const CollisionGeometry& geometry : model.geometries) {
    const int link = geometry.link;  // -1 is a robot's base
    const Pose pose = link < 0 ? basePose(world, model.index) : linkPose(world, model, link);
    const btCollisionObject* body =
        model.in_physics ? model.bodies.links[std::max(0, link)].body.get() : nullptr;
    add(geometry.shape, pose * geometry.pose_in_link, body);
  }
}

void RayScene::addSurfaces(const Model& model) {
  for (const LinkBody& surface : model.bodies.surfaces) {
    const btRigidBody& body = *surface.body;
    const btCollisionShape& shape = *body.getCollisionShape();
    if (shape.getShapeType() == STATIC_PLANE_PROXYTYPE) {
      const auto& plane = static_cast<const btStaticPlaneShape&>(shape);
      const Vector3 normal =
          fromBullet(body.getWorldTransform().getBasis() * plane.getPlaneNormal());
      const Vector3 origin = fromBullet(body.getWorldTransform().getOrigin());
      planes_.push_back({normal, normal.Dot(from_ - origin) - plane.getPlaneConstant()});
      continue;
    }
    btVector3 min, max;
    body.getAabb(min, max);
    Target target;
    target.box = {fromBullet(min), fromBullet(max)};
    target.body = &body;
    add(target);
  }
}

/// `hull`: the body of a movable mesh; without one the mesh counts as its box.
void RayScene::add(const Shape& shape, const Pose& pose, const btCollisionObject* hull) {
  Target target;
  target.box = bounds(shape, pose);
  target.centre = pose.Pos();
  if (shape.kind == Shape::Kind::kMesh) {
    target.body = hull;
    target.centre = pose.CoordPositionAdd((shape.mesh->min + shape.mesh->max) * 0.5);
    if (!hull) target.solid = Solid(boxAround(*shape.mesh), pose.Rot());
  } else if (shape.kind == Shape::Kind::kSphere) {
    target.solid = Solid(ellipsoidOf(shape), pose.Rot());
  } else {
    target.solid = Solid(shape, pose.Rot());
  }
  add(std::move(target));
}

void RayScene::add(Target target) {
  if (squaredDistance(target.box, from_) > range_ * range_) return;
  target.box.min -= Vector3::One * kGrow;
  target.box.max += Vector3::One * kGrow;
  targets_.push_back(std::move(target));
}

/// Builds a tree of boxes, halved along the axis of the largest spread of their centres.
int RayScene::build(int first, int count) {
  const int index = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  Bounds box, middles;
  const auto middle = [](const Target& t) { return (t.box.min + t.box.max) * 0.5; };
  for (int i = first; i < first + count; ++i) {
    box.add(targets_[i].box);
    middles.add({middle(targets_[i]), middle(targets_[i])});
  }
  nodes_[index].box = box;
  if (count <= kLeaf) {
    nodes_[index].first = first;
    nodes_[index].count = count;
    return index;
  }
  const Vector3 spread = middles.max - middles.min;
  const int axis = spread.X() >= spread.Y() && spread.X() >= spread.Z() ? 0
                   : spread.Y() >= spread.Z()                           ? 1
                                                                        : 2;
  const int half = count / 2;
  std::nth_element(
      targets_.begin() + first, targets_.begin() + first + half, targets_.begin() + first + count,
      [&](const Target& a, const Target& b) { return middle(a)[axis] < middle(b)[axis]; });
  build(first, half);
  const int right = build(first + half, count - half);
  nodes_[index].right = right;
  return index;
}

double RayScene::cast(const Target& target, const Vector3& direction, double range) const {
  if (target.body) return castBody(*target.body, from_, direction, range);
  return target.solid.cast(from_ - target.centre, direction);
}

double RayScene::cast(const Vector3& direction) const {
  double range = range_;
  bool is_hit = false;
  const auto meet = [&](double distance) {
    if (distance > range) return;
    range = distance;
    is_hit = true;
  };
  for (const Plane& plane : planes_) {
    const double towards = -plane.normal.Dot(direction);
    if (towards > 0 && plane.height >= 0) meet(plane.height / towards);
  }
  const Vector3 inverse = inverseOf(direction);
  int stack[kDeepest];
  int waiting = 0;
  if (!nodes_.empty()) stack[waiting++] = 0;
  while (waiting > 0) {
    const int at = stack[--waiting];
    const Node& node = nodes_[at];
    if (enter(node.box, from_, inverse, range) == kInfinity) continue;
    if (node.right >= 0) {
      stack[waiting++] = node.right;
      stack[waiting++] = at + 1;
      continue;
    }
    for (int i = node.first; i < node.first + node.count; ++i) {
      if (enter(targets_[i].box, from_, inverse, range) == kInfinity) continue;
      meet(cast(targets_[i], direction, range));
    }
  }
  return is_hit ? range : kInfinity;
}

}  // namespace kiva
