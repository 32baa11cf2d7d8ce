// SPDX-License-Identifier: Apache-2.0
#include "scenery.h"

#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "kiva_plugin_cpp/look.h"
#include "ros/messages/convert.h"

namespace kiva_ros {
namespace {

using warehouse_msgs::Look;

constexpr bool areSame(int kind, int in_message) { return kind == in_message; }
static_assert(areSame(kiva::Look::kBox, Look::BOX) && areSame(kiva::Look::kSphere, Look::SPHERE) &&
              areSame(kiva::Look::kCylinder, Look::CYLINDER) &&
              areSame(kiva::Look::kCapsule, Look::CAPSULE) &&
              areSame(kiva::Look::kEllipsoid, Look::ELLIPSOID) &&
              areSame(kiva::Look::kPlane, Look::PLANE));

Look toMessage(kiva::Look look) {
  Look out;
  out.links = std::move(look.links);
  out.link_pose = std::move(look.link_pose);
  out.shape_link = std::move(look.shape_link);
  out.shape_kind = std::move(look.shape_kind);
  out.shape_pose = std::move(look.shape_pose);
  out.shape_size = std::move(look.shape_size);
  out.shape_colour = std::move(look.shape_colour);
  return out;
}

/// Collects the looks of a scenery, each description once.
class Looks {
 public:
  Looks(const kiva::World& world, std::vector<Look>* out) : world_(world), out_(*out) {}

  int of(const std::string& model) {
    const auto description = world_.description(model);
    const auto [at, is_new] = known_.emplace(description, static_cast<int>(out_.size()));
    if (is_new) out_.push_back(toMessage(kiva::lookOf(*description)));
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
  const kiva::FloorExtent& floor = world.floor();
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
