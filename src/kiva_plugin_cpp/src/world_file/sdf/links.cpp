// SPDX-License-Identifier: Apache-2.0
#include "world_file/sdf/links.h"

#include "world_file/elements/frames.h"
#include "world_file/elements/inertia.h"
#include "world_file/elements/values.h"
#include "world_file/sdf/stand_in.h"

namespace kiva {
namespace {

void addCollision(const XmlElement& from, const XmlElement& part, const Scope& scope, Link* link,
                  Faults* warnings) {
  Collision collision;
  collision.name = attributeOf(part, "name");
  collision.pose_in_link = poseAround(part);
  readSurface(part, &collision, warnings);
  try {
    const auto shape = readShape(part, scope.origin, MeshUse::kTouched);
    if (!shape) return;
    collision.shape = *shape;
    link->collisions.push_back(collision);
  } catch (const SdfError& lost) {
    addStandIn(from, part, collision, lost, scope.origin, scope.is_static, link, warnings);
  }
}

void addVisual(const XmlElement& from, const Origin& origin, Link* link, Faults* warnings) {
  // Pictures show collisions in place of a visual's mesh; a link without collisions needs the mesh
  // itself.
  const MeshUse use = link->collisions.empty() ? MeshUse::kTouched : MeshUse::kSeen;
  const auto shape = readShape(from, origin, use);
  if (!shape) return;
  Visual visual;
  visual.name = attributeOf(from, "name");
  visual.pose_in_link = poseAround(from);
  visual.shape = *shape;
  readMaterial(from, &visual, warnings);
  link->visuals.push_back(visual);
}

}  // namespace

Link describeLink(const XmlElement& from, const Scope& scope, Faults* warnings) {
  Link link;
  link.name = scope.prefix + attributeOf(from, "name");
  link.pose_in_model = scope.pose * poseAround(from);
  link.gravity = flagIn(from, "gravity", true);
  link.self_collide = flagIn(from, "self_collide", scope.self_collide);
  setInertia(from.FirstChildElement("inertial"), &link);
  forEach(from, "collision", [&](const XmlElement& part) {
    buildOrLeaveOut("collision", warnings,
                    [&] { addCollision(from, part, scope, &link, warnings); });
  });
  forEach(from, "visual", [&](const XmlElement& part) {
    buildOrLeaveOut("visual", warnings, [&] { addVisual(part, scope.origin, &link, warnings); });
  });
  return link;
}

}  // namespace kiva
