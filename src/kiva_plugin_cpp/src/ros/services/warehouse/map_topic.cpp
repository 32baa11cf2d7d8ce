// SPDX-License-Identifier: Apache-2.0
#include "ros/services/warehouse/map_topic.h"

#include <chrono>

namespace kiva_ros {
namespace {

constexpr int kMapQueue = 1;
constexpr auto kInterval = std::chrono::seconds(1);  // a warehouse is built in many requests
constexpr double kCoarser = 1e-9;                    // [m]
constexpr char kFrame[] = "map";

}  // namespace

MapTopic::MapTopic(ros::NodeHandle& root, SimulationThread& simulation, double resolution)
    : simulation_(simulation),
      resolution_(resolution),
      map_(root, "map", kMapQueue,
           [this](int change) {
             subscribers_ += change;
             if (change <= 0) return;
             simulation_.post([this](kiva::World& world) { publishIfStale(world); });
           }),
      server_(root.advertiseService("static_map", &MapTopic::get, this)) {}

void MapTopic::afterStep(kiva::World& world) {
  if (!is_stale_ || subscribers_ == 0 || WallClock::now() < published_ + kInterval) return;
  publishIfStale(world);
}

void MapTopic::publishIfStale(kiva::World& world) {
  is_stale_ = false;
  if (revision_ == world.modelsRevision()) return;
  revision_ = world.modelsRevision();
  map_.publish(make(world));
  published_ = WallClock::now();
}

nav_msgs::OccupancyGrid MapTopic::make(const kiva::World& world) const {
  const kiva::LaserMap map = world.laserMap(resolution_);
  if (map.resolution > resolution_ + kCoarser) {
    ROS_WARN_ONCE("map_resolution is %g m, of which the floor has too many cells: /map has %g m",
                  resolution_, map.resolution);
  }
  nav_msgs::OccupancyGrid out;
  out.header.stamp = out.info.map_load_time = ros::Time(world.time());
  out.header.frame_id = kFrame;
  out.info.resolution = static_cast<float>(map.resolution);
  out.info.width = static_cast<uint32_t>(map.columns);
  out.info.height = static_cast<uint32_t>(map.rows);
  out.info.origin.position.x = map.x;
  out.info.origin.position.y = map.y;
  out.info.origin.position.z = map.z;
  out.info.origin.orientation.w = 1;
  out.data.assign(map.cells.begin(), map.cells.end());
  return out;
}

bool MapTopic::get(nav_msgs::GetMap::Request&, nav_msgs::GetMap::Response& response) {
  response.map = simulation_.run([this](kiva::World& world) { return make(world); });
  return true;
}

}  // namespace kiva_ros
