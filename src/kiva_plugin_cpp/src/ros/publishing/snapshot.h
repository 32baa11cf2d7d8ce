// SPDX-License-Identifier: Apache-2.0
//
// Data that the step thread hands to the broadcaster: copies, so that neither waits for the other.
#pragma once

#include <warehouse_msgs/FleetState.h>
#include <warehouse_msgs/People.h>
#include <warehouse_msgs/UnitStates.h>
#include <warehouse_msgs/WarehouseObjects.h>

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "kiva_plugin_cpp/world.h"
#include "ros/transport/publish_queue.h"

namespace kiva_ros {

/// The constants of a robot that its topics need.
struct RobotInfo {
  int id = 0;
  kiva::LaserParameters laser;
  kiva::Pose left_wheel, right_wheel, tower;  ///< In base_link, with all joints at zero.
};
using RobotInfos = std::vector<RobotInfo>;

struct Scan {
  int kiva_id = 0;
  std::vector<float> ranges;
};

struct RobotPose {
  int kiva_id = 0;
  kiva::Pose base;       ///< In world; of the odometry of a steered robot, in kiva<id>/odom.
  kiva::Twist twist;     ///< In base_link.
  bool is_exact = true;  ///< Whether pose and twist are the true ones; then all that follows is 0.
  std::array<double, 9> pose_covariance{};   ///< Covariance of x, y, yaw.
  std::array<double, 4> twist_covariance{};  ///< Covariance of forward speed and turn rate.
  double wheel_angle[2] = {0, 0};            ///< Left, right [rad].
  double tower = 0;                          ///< Height above its rest [m].
  std::optional<kiva::Pose> counted;         ///< A steered robot's base_link in kiva<id>/odom.
};

/// The states of all models, or of all links.
struct ModelStates {
  std::shared_ptr<const std::vector<std::string>>
      names;  ///< The same object while no name changes.
  std::vector<kiva::EntityState> states;
};

/// The data of one moment of the world that are due to be published.
struct Snapshot {
  double time = 0;  ///< Simulated [s].

  // Reliable parts: each reaches the broadcaster.
  bool reliable_clock = false;  ///< To be published, whatever the rate of /clock.
  std::vector<kiva::Event> events;
  std::optional<RobotInfos> robots;  ///< All robots, after some were added or removed.
  std::vector<kiva::StatusChange> statuses;
  std::optional<warehouse_msgs::WarehouseObjects> objects;
  std::optional<warehouse_msgs::UnitStates> units;
  std::vector<PublishQueue::Publication> publications;  ///< Messages of plugins.
  std::string state_hash;                               ///< Empty if it is not due.
  std::function<void()> published;  ///< Called when this snapshot is written to sockets.
  bool reliable = false;  ///< Whether nothing may be dropped, since a client waits for the step.

  // Best-effort parts: dropped if the broadcaster lags, since the next ones replace them.
  bool clock = false;
  std::optional<warehouse_msgs::People> people;
  std::optional<warehouse_msgs::FleetState> fleet;
  std::optional<ModelStates> models;
  std::optional<ModelStates> links;
  std::vector<kiva::StatusChange> heartbeats;  ///< Status of robots with subscribers.
  std::vector<Scan> scans;
  std::vector<RobotPose> odometry;
  std::vector<RobotPose> transforms;

  /// Returns the number of messages to topics of single robots.
  std::size_t bulk() const { return heartbeats.size() + scans.size() + odometry.size(); }
  bool hasReliable() const {
    return reliable_clock || !events.empty() || robots || !statuses.empty() || objects || units ||
           !publications.empty() || !state_hash.empty() || published;
  }
  bool hasBestEffort() const {
    return clock || people || fleet || models || links || !heartbeats.empty() || !scans.empty() ||
           !odometry.empty() || !transforms.empty();
  }
  void dropBestEffort() {
    clock = false;
    people.reset();
    fleet.reset();
    models.reset();
    links.reset();
    heartbeats.clear();
    scans.clear();
    odometry.clear();
    transforms.clear();
  }
};

}  // namespace kiva_ros
