// SPDX-License-Identifier: Apache-2.0
#include "scenery.h"

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "ros/messages/convert.h"

namespace kiva_ros {
namespace {

using warehouse_msgs::Look;

constexpr float kPlain[4] = {0.7F, 0.7F, 0.7F, 1};  // of what has a shape but no look

std::uint8_t kindOf(kiva::Shape::Kind kind) {
  switch (kind) {
    case kiva::Shape::Kind::kSphere:
      return Look::SPHERE;
    case kiva::Shape::Kind::kCylinder:
      return Look::CYLINDER;
    case kiva::Shape::Kind::kCapsule:
      return Look::CAPSULE;
    case kiva::Shape::Kind::kEllipsoid:
      return Look::ELLIPSOID;
    case kiva::Shape::Kind::kPlane:
      return Look::PLANE;
    default:
      return Look::BOX;
  }
}

/// Full extent along the shape's own axes [m].
kiva::Vector3 extentOf(const kiva::Shape& shape) {
  const double width = 2 * shape.radius;
  switch (shape.kind) {
    case kiva::Shape::Kind::kSphere:
      return {width, width, width};
    case kiva::Shape::Kind::kCylinder:
      return {width, width, shape.length};
    case kiva::Shape::Kind::kCapsule:
      return {width, width, shape.length + width};
    case kiva::Shape::Kind::kEllipsoid:
      return shape.size * 2;
    case kiva::Shape::Kind::kPlane:
      return {shape.plane_size[0], shape.plane_size[1], 0};
    default:
      return shape.size;
  }
}

template <typename Colour>
void addShape(int link, const kiva::Pose& pose, const kiva::Shape& shape, const Colour& colour,
              Look* out) {
  out->shape_link.push_back(link);
  out->shape_kind.push_back(kindOf(shape.kind));
  append(pose, &out->shape_pose);
  const kiva::Vector3 extent = extentOf(shape);
  for (int axis = 0; axis < 3; ++axis) out->shape_size.push_back(extent[axis]);
  for (int channel = 0; channel < 4; ++channel) {
    out->shape_colour.push_back(static_cast<float>(colour[channel]));
  }
}

bool isSeen(const kiva::Link& link) { return !link.visuals.empty(); }

/// Its visuals; where it has none at all, what touches.
Look lookOf(const kiva::ModelDescription& model) {
  Look out;
  const bool seen = std::any_of(model.links.begin(), model.links.end(), isSeen);
  for (const kiva::Link& link : model.links) {
    const int index = static_cast<int>(out.links.size());
    out.links.push_back(link.name);
    append(link.pose_in_model, &out.link_pose);
    for (const auto& v : link.visuals) addShape(index, v.pose_in_link, v.shape, v.rgba, &out);
    if (seen) continue;
    for (const auto& c : link.collisions) addShape(index, c.pose_in_link, c.shape, kPlain, &out);
  }
  return out;
}

/// The looks of a scenery, each description but once.
class Looks {
 public:
  Looks(const kiva::World& world, std::vector<Look>* out) : world_(world), out_(*out) {}

  int of(const std::string& model) {
    const auto description = world_.description(model);
    const auto [at, is_new] = known_.emplace(description, static_cast<int>(out_.size()));
    if (is_new) out_.push_back(lookOf(*description));
    return at->second;
  }
  template <typename Models>
  int ofFirst(const Models& models) {
    return models.empty() ? -1 : of(models.front().name);
  }

 private:
  const kiva::World& world_;
  std::vector<Look>& out_;
  std::map<std::shared_ptr<const kiva::ModelDescription>, int> known_;
};

bool isScenery(kiva::ModelKind kind) {
  return kind == kiva::ModelKind::kBelt || kind == kiva::ModelKind::kOther;
}

}  // namespace

warehouse_msgs::Scenery sceneryOf(const kiva::World& world) {
  warehouse_msgs::Scenery out;
  out.header = header(world.time(), "world");
  const kiva::Floor& floor = world.floor();
  out.floor = {floor.min_x, floor.max_x, floor.min_y, floor.max_y};
  out.grid_spacing = world.gridSpacing();
  Looks looks(world, &out.looks);
  out.kiva_look = looks.ofFirst(world.fleet().robots);
  out.storage_unit_look = looks.ofFirst(world.storageUnits());
  out.item_look = looks.ofFirst(world.items());
  for (const std::string& name : world.modelNames()) {
    if (!isScenery(world.kind(name))) continue;
    out.models.push_back(name);
    out.model_look.push_back(looks.of(name));
  }
  updatePoses(world, &out);
  return out;
}

bool updatePoses(const kiva::World& world, warehouse_msgs::Scenery* scenery) {
  std::vector<double> poses;
  for (const std::string& name : scenery->models) append(world.state(name)->pose, &poses);
  scenery->header = header(world.time(), "world");
  const bool moved = poses != scenery->pose;
  scenery->pose = std::move(poses);
  return moved;
}

warehouse_msgs::FleetPaths pathsOf(const kiva::World& world) {
  warehouse_msgs::FleetPaths out;
  out.stamp = ros::Time(world.time());
  for (int robot = 0; robot < world.fleet().size(); ++robot) {
    const std::vector<kiva::PathPoint> path = world.pathAhead(robot);
    if (path.empty()) continue;
    for (const kiva::PathPoint& point : path) {
      out.x.push_back(point.x);
      out.y.push_back(point.y);
    }
    out.kiva_id.push_back(world.fleet().robots[robot].id);
    out.points.push_back(static_cast<std::uint32_t>(path.size()));
  }
  return out;
}

}  // namespace kiva_ros
