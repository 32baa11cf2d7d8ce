// SPDX-License-Identifier: Apache-2.0
#include "world_file/links.h"

#include <sdf/Collision.hh>
#include <sdf/Visual.hh>

#include "world_file/elements.h"
#include "world_file/errors.h"
#include "world_file/inertia.h"
#include "world_file/shapes.h"
#include "world_file/stand_in.h"

namespace kiva {
namespace {

void addCollision(const sdf::Link& from, const sdf::Collision& part, const Scope& scope, Link* link,
                  sdf::Errors* warnings) {
  Collision collision;
  collision.name = part.Name();
  collision.pose_in_link = resolved(part.SemanticPose(), part.Element());
  readSurface(part.Element(), &collision, warnings);
  try {
    const auto shape = readShape(part.Element(), scope.origin, MeshUse::kTouched);
    if (!shape) return;
    collision.shape = *shape;
    link->collisions.push_back(collision);
  } catch (const SdfError& lost) {
    addStandIn(from, collision, lost, scope.origin, scope.is_static, link, warnings);
  }
}

void addVisual(const sdf::Visual& from, const Origin& origin, Link* link, sdf::Errors* warnings) {
  // Pictures show what touches in place of a mesh; where nothing does, they need the mesh itself.
  const MeshUse use = link->collisions.empty() ? MeshUse::kTouched : MeshUse::kSeen;
  const auto shape = readShape(from.Element(), origin, use);
  if (!shape) return;
  Visual visual;
  visual.name = from.Name();
  visual.pose_in_link = resolved(from.SemanticPose(), from.Element());
  visual.shape = *shape;
  readMaterial(from.Element(), &visual, warnings);
  link->visuals.push_back(visual);
}

}  // namespace

Link describeLink(const sdf::Link& from, const Scope& scope, sdf::Errors* warnings) {
  Link link;
  link.name = scope.prefix + from.Name();
  link.pose_in_model = scope.pose * resolved(from.SemanticPose(), from.Element(), "__model__");
  link.gravity = from.Element()->Get<bool>("gravity", true).first;
  setInertia(from.Inertial(), &link);
  for (uint64_t i = 0; i < from.CollisionCount(); ++i) {
    buildOrLeaveOut("collision", warnings,
                    [&] { addCollision(from, *from.CollisionByIndex(i), scope, &link, warnings); });
  }
  for (uint64_t i = 0; i < from.VisualCount(); ++i) {
    buildOrLeaveOut("visual", warnings,
                    [&] { addVisual(*from.VisualByIndex(i), scope.origin, &link, warnings); });
  }
  return link;
}

}  // namespace kiva
