// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <geometry_msgs/Twist.h>
#include <ros/ros.h>
#include <warehouse_msgs/SetCmdVel.h>

#include <map>
#include <set>
#include <string>
#include <vector>

#include "ros/gazebo_plugins/base/plugin_inputs.h"
#include "ros/publishing/reporter.h"
#include "ros/simulation/simulation_thread.h"
#include "ros/simulation/step_hook.h"

namespace kiva_ros {

/// Robots that take velocities: subscribes to `/kiva<id>/cmd_vel` of each, and serves
/// `/warehouse/set_cmd_vel`, which hands robots over and takes them back.
class VelocityDrive : public StepHook {
 public:
  /// `kiva_ids`: the robots that take velocities as soon as they are spawned.
  VelocityDrive(ros::NodeHandle& root, SimulationThread& simulation, Reporter& reporter,
                PluginInputs& inputs, const kiva::World& world, const std::vector<int>& kiva_ids);

  bool beforeStep(kiva::World& world) override;

 private:
  using Request = warehouse_msgs::SetCmdVel::Request;
  using Response = warehouse_msgs::SetCmdVel::Response;

  /// A robot's subscription, and the time until which its faults are not reported again [s].
  struct Rein {
    PluginInput<geometry_msgs::Twist> input;
    double quiet_until = 0;
  };

  bool set(const Request& request, Response& response);
  void handOver(kiva::World& world);
  void subscribe(const kiva::World& world);
  void take(kiva::World& world, int kiva_id, const geometry_msgs::Twist& twist, Rein& rein);

  ros::NodeHandle& root_;
  SimulationThread& simulation_;
  Reporter& reporter_;
  PluginInputs& inputs_;
  std::set<int> waiting_;      ///< Robots to hand over once they are spawned.
  std::map<int, Rein> reins_;  ///< By the robot's id.
  ros::ServiceServer server_;
};

}  // namespace kiva_ros
