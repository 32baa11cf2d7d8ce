// SPDX-License-Identifier: Apache-2.0
#include "world_file/sdf/stand_in.h"

#include <algorithm>
#include <cmath>

#include "world_file/elements/frames.h"
#include "world_file/elements/values.h"

namespace kiva {
namespace {

constexpr double kEdge = 1;               // [m]
constexpr double kBelow = 2, kAbove = 1;  // [m] below and above the place of an unknown shape
constexpr double kNoDistance = 1e-3;      // [m]

Shape boxOf(const Vector3& size) {
  Shape shape;
  shape.size = size;
  return shape;
}

/// Returns the visuals of a link as collisions: those at `place` in it, or all.
std::vector<Collision> visualsOf(const XmlElement& from, const std::optional<Pose>& place,
                                 const Origin& origin) {
  std::vector<Collision> visuals;
  forEach(from, "visual", [&](const XmlElement& visual) {
    Faults ignored;  // Reported where visuals are read.
    buildOrLeaveOut("visual", &ignored, [&] {
      const Pose pose = poseAround(visual);
      if (place && pose.Pos().Distance(place->Pos()) > kNoDistance) return;
      const auto shape = readShape(visual, origin, MeshUse::kTouched);
      if (!shape || shape->kind == Shape::Kind::kPlane) return;
      Collision collision;
      collision.pose_in_link = pose;
      collision.shape = *shape;
      visuals.push_back(collision);
    });
  });
  return visuals;
}

/// Returns the box of a heightmap, which in SDF lies around its origin, and above it.
std::vector<Collision> boxOfHeightmap(const Collision& lost, const XmlElement& heightmap) {
  const Vector3 size = vectorIn(heightmap, "size", Vector3::One);
  const Vector3 at = vectorIn(heightmap, "pos", Vector3::Zero);
  if (!size.IsFinite() || !at.IsFinite() || size.Min() <= 0) return {};
  Collision box = lost;
  box.shape = boxOf(size);
  box.pose_in_link = lost.pose_in_link * Pose(at + Vector3(0, 0, size.Z() / 2), {1, 0, 0, 0});
  return {box};
}

const XmlElement* heightmapOf(const XmlElement& collision) {
  const XmlElement* const geometry = collision.FirstChildElement("geometry");
  return geometry ? geometry->FirstChildElement("heightmap") : nullptr;
}

/// Returns a box that is upright in the model, however the link is rotated.
Collision boxAround(const Collision& lost, const Pose& link_in_model) {
  Collision box = lost;
  box.shape = boxOf({kEdge, kEdge, kAbove + kBelow});
  const Vector3 place = (link_in_model * lost.pose_in_link).Pos();
  const Pose in_model(place + Vector3(0, 0, (kAbove - kBelow) / 2), Quaternion::Identity);
  box.pose_in_link = link_in_model.Inverse() * in_model;
  return box;
}

bool isEmpty(const XmlElement& collision) {
  const XmlElement* const geometry = collision.FirstChildElement("geometry");
  return geometry && geometry->FirstChildElement("empty");
}

void warn(const SdfError& cause, const std::string& instead, Faults* warnings) {
  warnings->push_back(
      reworded(cause.error(), "this collision is left out: " + cause.error().message + instead));
}

}  // namespace

std::string nameIn(const std::string& uri) {
  const std::size_t end = uri.find_last_not_of('/');
  const std::string whole = uri.substr(0, end + 1);
  return whole.substr(whole.find_last_of('/') + 1);
}

void addStandIn(const XmlElement& from, const XmlElement& collision, const Collision& lost,
                const SdfError& cause, const Origin& origin, bool is_static, Link* link,
                Faults* warnings) {
  std::string instead = "; what the link shows stands in for it";
  std::vector<Collision> visuals = visualsOf(from, lost.pose_in_link, origin);
  if (visuals.empty()) visuals = visualsOf(from, std::nullopt, origin);
  if (const XmlElement* const heightmap = heightmapOf(collision)) {
    visuals = boxOfHeightmap(lost, *heightmap);
    instead = "; the box around it stands in for it";
  }
  if (visuals.empty() && is_static) {
    visuals = {boxAround(lost, link->pose_in_model)};
    instead = kStandsIn;
  }
  warn(cause, visuals.empty() ? "" : instead, warnings);
  for (std::size_t i = 0; i < visuals.size(); ++i) {
    visuals[i].name = lost.name + (i > 0 ? "_" + std::to_string(i + 1) : "");
    visuals[i].friction = lost.friction;
    visuals[i].restitution = lost.restitution;
    link->collisions.push_back(visuals[i]);
  }
}

void addStandIn(const XmlElement& from, ModelDescription* description, Faults* warnings) {
  bool asks = false;
  forEach(from, "link", [&](const XmlElement& link) {
    forEach(link, "collision", [&](const XmlElement& collision) { asks |= !isEmpty(collision); });
  });
  const bool has_some = std::any_of(description->links.begin(), description->links.end(),
                                    [](const Link& link) { return !link.collisions.empty(); });
  if (!asks || has_some || description->is_static || description->links.empty()) return;
  Link& link = description->links.front();
  Collision cube;
  cube.name = "stand_in";
  cube.shape = boxOf({kEdge, kEdge, kEdge});
  const Vector3 at(link.pose_in_model.X(), link.pose_in_model.Y(), kEdge / 2);
  cube.pose_in_link = link.pose_in_model.Inverse() * Pose(at, Quaternion::Identity);
  link.collisions.push_back(cube);
  warnings->push_back(
      noteAt(from, "none of its collisions can be had; a cube of 1 m stands in for them"));
}

}  // namespace kiva
