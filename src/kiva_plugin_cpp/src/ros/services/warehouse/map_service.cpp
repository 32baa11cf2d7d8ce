// SPDX-License-Identifier: Apache-2.0
#include "ros/services/warehouse/map_service.h"

namespace kiva_ros {

MapService::MapService(ros::NodeHandle& root, SimulationThread& simulation)
    : simulation_(simulation),
      server_(root.advertiseService("warehouse/map", &MapService::get, this)) {}

bool MapService::get(nav_msgs::GetMap::Request&, nav_msgs::GetMap::Response& response) {
  const kiva::Occupancy found =
      simulation_.run([](kiva::World& world) { return world.occupancy(); });
  nav_msgs::OccupancyGrid& map = response.map;
  map.header.stamp = map.info.map_load_time = ros::Time::now();
  map.header.frame_id = "world";
  map.info.resolution = static_cast<float>(found.spacing);
  map.info.width = static_cast<uint32_t>(found.columns);
  map.info.height = static_cast<uint32_t>(found.rows);
  map.info.origin.position.x = found.x - found.spacing / 2;
  map.info.origin.position.y = found.y - found.spacing / 2;
  map.info.origin.position.z = found.z;
  map.info.origin.orientation.w = 1;
  map.data.assign(found.cells.begin(), found.cells.end());
  return true;
}

}  // namespace kiva_ros
