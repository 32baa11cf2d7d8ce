// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <nav_msgs/GetMap.h>
#include <nav_msgs/OccupancyGrid.h>
#include <ros/ros.h>

#include <atomic>
#include <cstdint>

#include "ros/simulation/simulation_thread.h"
#include "ros/simulation/step_hook.h"
#include "ros/transport/latched_publisher.h"
#include "ros/transport/wall_clock.h"

namespace kiva_ros {

/// Publishes `/map`, latched: the floor as robots' lasers see it. It is made when someone
/// subscribes, and again after models came or went; where storage units are set down changes
/// nothing, since a localisation would begin again. `/static_map` answers with the map of this
/// moment.
class MapTopic : public StepHook {
 public:
  /// `resolution`: edge of a cell [m].
  MapTopic(ros::NodeHandle& root, SimulationThread& simulation, double resolution);

  void onChange() override { is_stale_ = true; }
  void afterStep(kiva::World& world) override;

 private:
  bool get(nav_msgs::GetMap::Request& request, nav_msgs::GetMap::Response& response);
  void publishIfStale(kiva::World& world);
  nav_msgs::OccupancyGrid make(const kiva::World& world) const;

  SimulationThread& simulation_;
  const double resolution_;
  std::atomic<int> subscribers_{0};
  bool is_stale_ = true;             ///< Of the step thread, like the next two.
  std::uint64_t revision_ = ~0ull;   ///< Of the models in the map last published.
  WallClock::time_point published_;  ///< When that was.
  LatchedPublisher<nav_msgs::OccupancyGrid> map_;
  ros::ServiceServer server_;
};

}  // namespace kiva_ros
