// SPDX-License-Identifier: Apache-2.0
#include <cmath>
#include <limits>

#include "core/models/models.h"
#include "core/motion/driving/drives.h"
#include "core/motion/driving/self_location.h"
#include "core/parallel/workers.h"
#include "core/sensing/look_ahead.h"
#include "core/sensing/ray_scene.h"
#include "core/sensing/scans.h"
#include "core/state/places/poses.h"
#include "core/state/progress/path_progress.h"
#include "core/state/world_state.h"
#include "kiva_plugin_cpp/world.h"

namespace kiva {
namespace {

constexpr int kScansTogether = 16;   // on one thread
constexpr int kRaysTogether = 1000;  // on one thread
constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

const Fleet& World::fleet() const { return state_->fleet; }
const std::vector<StorageUnit>& World::storageUnits() const { return state_->storage.units; }
const std::vector<Item>& World::items() const { return state_->storage.items; }
Pose World::storageUnitPose(int unit) const { return unitPose(state_->view, unit); }
Pose World::itemPose(int item) const { return kiva::itemPose(state_->view, item); }

std::vector<PathPoint> World::pathAhead(int robot) const {
  const Task& task = state_->fleet.tasks[robot];
  if (task.follows()) return pointsAhead(state_->view.fleet, robot);
  std::vector<PathPoint> points;
  for (const MotionSegment& segment : task.segments) {
    if (segment.kind == MotionSegment::Kind::kDrive) points.push_back({segment.x, segment.y});
  }
  return points;
}

Vector3 World::believedPose(int robot) const {
  const PlanarPose at = state_->fleet.believed(robot);
  return {at.x, at.y, at.yaw};
}

Odometry World::odometry(int robot) const { return odometryOf(state_->view, robot); }
double World::loadLimit(int robot) const { return kiva::loadLimit(state_->view, robot); }
Pose World::basePose(int robot) const { return kiva::basePose(state_->view, robot); }
std::uint64_t World::unitsRevision() const { return state_->storage.revision; }
const FloorExtent& World::floor() const { return state_->floor.extent; }
double World::gridSpacing() const { return state_->settings.grid_spacing; }

void World::scan(int robot, std::vector<float>* ranges) const {
  static thread_local FanHits hits;
  const LaserParameters& laser = state_->fleet.robots[robot].laser;
  castRays(state_->view, state_->scans, robot, {laser.max_range, kInfinity}, &hits);
  if (isBlind(state_->view.fleet, robot)) {
    ranges->assign(laser.rays, std::numeric_limits<float>::quiet_NaN());
    return;
  }
  ranges->assign(laser.rays, static_cast<float>(kInfinity));
  for (int ray = hits.first; ray <= hits.last; ++ray) {
    if (hits.model[ray] < 0) continue;
    const double range = hits.range[ray];
    (*ranges)[ray] = static_cast<float>(range < laser.min_range ? -kInfinity : range);
  }
}

void World::scan(const std::vector<int>& robots, std::vector<std::vector<float>>* ranges) const {
  ranges->resize(robots.size());
  state_->schedule.workers->share(static_cast<int>(robots.size()), kScansTogether,
                                  [&](int begin, int end) {
                                    for (int k = begin; k < end; ++k)
                                      scan(robots[k], &(*ranges)[k]);
                                  });
}

const std::vector<int>& World::scansDue() const { return state_->scans.due; }

double World::rayCast(const Vector3& from, double yaw, double range, const std::string& but) const {
  const Model* passed = state_->models.find(but);
  const int group = passed ? passed->owner->group(*passed) : -1;
  return state_->obstacles
      .cast(from.X(), from.Y(), from.Z(), std::cos(yaw), std::sin(yaw), range, group)
      .range;
}

void World::rayCast(const Vector3& from, const std::vector<Vector3>& directions, double range,
                    const std::string& but, std::vector<double>* ranges) const {
  const RayScene scene(state_->view, from, range, state_->models.find(but));
  ranges->resize(directions.size());
  const int rays = static_cast<int>(directions.size());
  state_->schedule.workers->share(rays, kRaysTogether, [&](int begin, int end) {
    for (int k = begin; k < end; ++k) (*ranges)[k] = scene.cast(directions[k]);
  });
}

std::vector<ContactPoint> World::contacts(const std::string& model) const {
  const auto at = state_->models.slot_of_name.find(model);
  if (at == state_->models.slot_of_name.end()) return {};
  return contactsOf(state_->view, at->second);
}

}  // namespace kiva
