// SPDX-License-Identifier: Apache-2.0
#include "kiva_plugin_cpp/look.h"

#include <algorithm>

#include "outline.h"

namespace kiva {
namespace {

constexpr float kPlain[4] = {0.7F, 0.7F, 0.7F, 1};  // colour of shapes without a material

Look::Kind kindOf(Shape::Kind kind) {
  switch (kind) {
    case Shape::Kind::kSphere:
      return Look::kSphere;
    case Shape::Kind::kCylinder:
      return Look::kCylinder;
    case Shape::Kind::kCapsule:
      return Look::kCapsule;
    case Shape::Kind::kEllipsoid:
      return Look::kEllipsoid;
    case Shape::Kind::kPlane:
      return Look::kPlane;
    default:
      return Look::kBox;
  }
}

/// Returns the full extent along the shape's own axes [m].
Vector3 extentOf(const Shape& shape) {
  const double width = 2 * shape.radius;
  switch (shape.kind) {
    case Shape::Kind::kSphere:
      return {width, width, width};
    case Shape::Kind::kCylinder:
      return {width, width, shape.length};
    case Shape::Kind::kCapsule:
      return {width, width, shape.length + width};
    case Shape::Kind::kEllipsoid:
      return shape.size * 2;
    case Shape::Kind::kPlane:
      return {shape.plane_size[0], shape.plane_size[1], 0};
    default:
      return shape.size;
  }
}

void append(const Pose& pose, std::vector<double>* out) {
  const Vector3& at = pose.Pos();
  const Quaternion& turn = pose.Rot();
  out->insert(out->end(), {at.X(), at.Y(), at.Z(), turn.X(), turn.Y(), turn.Z(), turn.W()});
}

template <typename Colour>
void addPart(int link, Look::Kind kind, const Pose& pose, const Vector3& extent,
             const Colour& colour, Look* out) {
  out->shape_link.push_back(link);
  out->shape_kind.push_back(kind);
  append(pose, &out->shape_pose);
  for (int axis = 0; axis < 3; ++axis) out->shape_size.push_back(extent[axis]);
  for (int channel = 0; channel < 4; ++channel) {
    out->shape_colour.push_back(static_cast<float>(colour[channel]));
  }
}

/// Adds a mesh as boxes: its outline from above.
template <typename Colour>
void addShape(int index, const Link& link, const Pose& pose, const Shape& shape,
              const Colour& colour, Look* out) {
  if (shape.kind != Shape::Kind::kMesh) {
    return addPart(index, kindOf(shape.kind), pose, extentOf(shape), colour, out);
  }
  if (!shape.mesh) return;
  for (const OutlineBox& box : outlineOf(*shape.mesh, link.pose_in_model * pose)) {
    const Pose in_link = link.pose_in_model.Inverse() * Pose(box.centre, Quaternion::Identity);
    addPart(index, Look::kBox, in_link, box.size, colour, out);
  }
}

/// Adds the visible shapes of a link. Meshes of visuals are not read: the link's collisions, which
/// are about as large, take their place.
void addVisuals(int index, const Link& link, Look* out) {
  bool has_touching = false;
  for (const Visual& visual : link.visuals) {
    const bool is_unread = visual.shape.kind == Shape::Kind::kMesh && !visual.shape.mesh;
    if (!is_unread) {
      addShape(index, link, visual.pose_in_link, visual.shape, visual.rgba, out);
    } else if (!has_touching) {
      for (const Collision& c : link.collisions) {
        addShape(index, link, c.pose_in_link, c.shape, visual.rgba, out);
      }
      has_touching = true;
    }
  }
}

bool isSeen(const Link& link) { return !link.visuals.empty(); }

}  // namespace

Look lookOf(const ModelDescription& model) {
  Look out;
  const bool is_visible = std::any_of(model.links.begin(), model.links.end(), isSeen);
  for (const Link& link : model.links) {
    const int index = static_cast<int>(out.links.size());
    out.links.push_back(link.name);
    append(link.pose_in_model, &out.link_pose);
    addVisuals(index, link, &out);
    if (is_visible) continue;
    for (const Collision& c : link.collisions) {
      addShape(index, link, c.pose_in_link, c.shape, kPlain, &out);
    }
  }
  return out;
}

}  // namespace kiva
