// SPDX-License-Identifier: Apache-2.0
#include "core/state/places/unit_geometry.h"

#include <algorithm>
#include <cmath>

#include "core/geometry/footprint.h"
#include "core/state/places/poses.h"

namespace kiva {
namespace {

constexpr double kAboveFloor = 0.05;  // [m]; lower faces are feet, not an underside
constexpr double kOnFloor = 0.005;    // [m]
constexpr double kUpright = 0.9999;   // cosine of a tilt of 0.8°

}  // namespace

double underside(const Scene& world, int unit) {
  const Model& model = *world.models[world.storage.units[unit].model];
  double lowest = 1e9;
  for (const Link& link : model.description->links) {
    for (const Collision& c : link.collisions) {
      const Bounds box = bounds(c.shape, link.pose_in_model * c.pose_in_link);
      const bool over_centre = box.min.X() <= 0 && box.max.X() >= 0 && box.min.Y() <= 0 &&
                               box.max.Y() >= 0 && box.min.Z() > kAboveFloor;
      if (over_centre) lowest = std::min(lowest, box.min.Z());
    }
  }
  return lowest;
}

bool standsUpright(const Scene& world, int unit) {
  const Pose pose = unitPose(world, unit);
  return std::abs(pose.Z() - world.floor.extent.z) < kOnFloor && pose.Rot().ZAxis().Z() > kUpright;
}

int unitAt(const Scene& world, const Vector3& point) {
  int unit_there = -1;
  const Footprint here = circleAt(point.X(), point.Y(), 0);
  world.obstacles.near(point.X(), point.Y(), 0.0, [&](const Footprint& f) {
    const Model& model = *world.models[f.model];
    if (unit_there >= 0 || !model.owner->holdsItems()) return;
    if (gap(f, here) <= 0 && point.Z() <= f.z_max && point.Z() >= f.z_min) unit_there = model.index;
  });
  return unit_there;
}

double towerGap(const Scene& world, int robot, int unit) {
  return underside(world, unit) - world.fleet.robots[robot].height;
}

double unitDistance(const Scene& world, int robot, int unit) {
  const Pose pose = unitPose(world, unit);
  return std::hypot(pose.X() - world.fleet.x[robot], pose.Y() - world.fleet.y[robot]);
}

}  // namespace kiva
